"""ImGui by its native backends: over a window's frame, or headless over any picture."""

from __future__ import annotations

# imgui_bundle before glfw: it names the libglfw that both must share.
from imgui_bundle import imgui  # isort: skip
from imgui_bundle.imgui import backends  # isort: skip
import glfw

from elemental.ui import theme
from elemental.ui.window import Window

GLSL_VERSION = "#version 430"
SCALES = (0.75, 1.0, 1.25, 1.5, 2.0)
"""Factors on the size of text and spacing that the View menu offers."""


class Gui:
    """An ImGui context. A frame is ``begin``, widgets, ``end``, and ``draw`` where it should show.

    Made while the GL context that draws is current. One at a time.
    """

    def __init__(self, display_scale: float) -> None:
        imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")  # else a file appears in the working directory
        io.set_log_filename("")
        io.config_flags |= imgui.ConfigFlags_.docking_enable.value
        io.config_windows_move_from_title_bar_only = True
        self.fonts = theme.load_fonts()
        theme.apply(display_scale)
        self.rests = True
        """Whether the last frame had no widgets."""

    @property
    def scale(self) -> float:
        """The user's factor on the size of everything."""
        return float(imgui.get_style().font_scale_main)

    @scale.setter
    def scale(self, factor: float) -> None:
        style = imgui.get_style()
        style.scale_all_sizes(factor / style.font_scale_main)
        style.font_scale_main = factor

    @property
    def wants_mouse(self) -> bool:
        """Whether the mouse is over a panel or dragging in one."""
        return not self.rests and bool(imgui.get_io().want_capture_mouse)

    @property
    def wants_keys(self) -> bool:
        """Whether a text field has the keyboard."""
        return not self.rests and bool(imgui.get_io().want_text_input)

    @property
    def holds(self) -> bool:
        """Whether a widget is held: a slider, a text field."""
        return not self.rests and bool(imgui.is_any_item_active())

    def rest(self) -> None:
        """A frame without widgets: what was pressed meanwhile is not theirs."""
        self.rests = True
        imgui.get_io().clear_events_queue()

    def begin(self, size: tuple[int, int], seconds: float) -> None:
        """Start a frame of ``size`` pixels, ``seconds`` after the one before."""
        raise NotImplementedError

    def end(self) -> None:
        """No more widgets."""
        imgui.render()
        self.rests = False

    def draw(self) -> None:
        """Draw into the bound framebuffer; the backend restores GL's state."""
        backends.opengl3_render_draw_data(imgui.get_draw_data())

    def release(self) -> None:
        """Free ImGui's GL objects and context."""
        backends.opengl3_shutdown()
        imgui.destroy_context()


class WindowGui(Gui):
    """ImGui in a window whose context is current.

    Made after the window has set its own callbacks: the backend passes events on to them.
    """

    def __init__(self, window: Window) -> None:
        super().__init__(max(1.0, glfw.get_window_content_scale(window.handle)[0]))
        backends.glfw_init_for_opengl(window.address, True)
        backends.opengl3_init(GLSL_VERSION)

    def begin(self, size: tuple[int, int], seconds: float) -> None:
        """Start a frame; the window knows its size and time itself."""
        backends.opengl3_new_frame()
        backends.glfw_new_frame()
        imgui.new_frame()

    def release(self) -> None:
        """Free ImGui's GL objects and context."""
        backends.opengl3_shutdown()
        backends.glfw_shutdown()
        imgui.destroy_context()


class HeadlessGui(Gui):
    """ImGui without a window; events come through ``imgui.get_io().add_…_event`` alone."""

    def __init__(self) -> None:
        super().__init__(1.0)
        imgui.get_io().config_input_trickle_event_queue = True
        backends.opengl3_init(GLSL_VERSION)

    def begin(self, size: tuple[int, int], seconds: float) -> None:
        """Start a frame of ``size`` pixels."""
        io = imgui.get_io()
        io.display_size = imgui.ImVec2(*size)
        io.delta_time = max(seconds, 1e-4)
        backends.opengl3_new_frame()
        imgui.new_frame()
