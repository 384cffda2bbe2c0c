"""ImGui over the frame, by its native glfw and OpenGL 3 backends."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

# imgui_bundle before glfw: it names the libglfw that both must share.
from imgui_bundle import imgui  # isort: skip
from imgui_bundle.imgui import backends  # isort: skip
import glfw

from elemental.ui.window import Window

FONT_PX = 15.0
"""Height of the text on a display without scaling."""


class Gui:
    """ImGui in a window whose context is current; ``frame`` draws into the bound framebuffer.

    Made after the window has set its own callbacks: the backend passes events on to them.
    """

    def __init__(self, window: Window) -> None:
        imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")  # else a file appears in the working directory
        io.set_log_filename("")
        style = imgui.get_style()
        style.font_size_base = FONT_PX
        style.font_scale_dpi = max(1.0, glfw.get_window_content_scale(window.handle)[0])
        style.window_rounding = 4.0
        backends.glfw_init_for_opengl(window.address, True)
        backends.opengl3_init("#version 430")

    @property
    def wants_mouse(self) -> bool:
        """Whether the mouse is over a panel or dragging in one."""
        return bool(imgui.get_io().want_capture_mouse)

    @property
    def wants_keys(self) -> bool:
        """Whether a text field has the keyboard."""
        return bool(imgui.get_io().want_text_input)

    @contextmanager
    def frame(self) -> Iterator[None]:
        """Panels made in the block are drawn at its end; the backend restores GL's state."""
        backends.opengl3_new_frame()
        backends.glfw_new_frame()
        imgui.new_frame()
        try:
            yield
        finally:
            imgui.render()
        backends.opengl3_render_draw_data(imgui.get_draw_data())

    def release(self) -> None:
        """Free ImGui's GL objects and context."""
        backends.opengl3_shutdown()
        backends.glfw_shutdown()
        imgui.destroy_context()
