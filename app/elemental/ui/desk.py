"""A scene on show: its picture, the panel around it, and what the two of them do.

The same in a window and headless: who owns it says how large it is and where it is drawn.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from elemental.core.errors import InputError
from elemental.frame import VIEWS, Frame, Renderer
from elemental.gpu.device import Device
from elemental.gpu.resources import Texture
from elemental.gpu.screen import Area
from elemental.scene.model import Camera
from elemental.session import Stage
from elemental.ui import actions, reopening, theme
from elemental.ui.clock import SceneClock
from elemental.ui.editor import Applied, document_of
from elemental.ui.fly_camera import FlyCamera
from elemental.ui.gui import Gui
from elemental.ui.images import ImageReader
from elemental.ui.in_view import begin_gizmo, gizmo_has_mouse
from elemental.ui.log import Kind
from elemental.ui.measured import Measured
from elemental.ui.notices import Notices
from elemental.ui.observers import Observers
from elemental.ui.pages import PageState, menu_of, overlays, pages_of
from elemental.ui.panel.file_dialog import FileDialog
from elemental.ui.panel.scene import SceneExtent
from elemental.ui.preferences import Preferences
from elemental.ui.present import present
from elemental.ui.sequence_job import SequenceJob
from elemental.ui.thumbnails import Thumbnails
from elemental.ui.widgets import Widgets
from elemental.ui.words import Rect
from elemental.ui.workspace import Workspace

if TYPE_CHECKING:
    from elemental.remote.server import Remote


@dataclass(frozen=True)
class Words:
    """What a scene is opened again with."""

    scene: str | None
    assignments: list[str]


class Desk:
    """One scene, one renderer, one document, one panel. ``onto``: a texture instead of a window."""

    def __init__(
        self,
        device: Device,
        gui: Gui,
        stage: Stage,
        words: Words,
        size: tuple[int, int],
        preferences: Preferences,
        *,
        onto: Texture | None = None,
        records: bool = False,
    ) -> None:
        self.device, self.gui, self.stage, self.words = device, gui, stage, words
        self.onto = onto
        self.renderer = Renderer(device, stage.scene, stage.settings, size)
        self.renderer.spreads_gathers = True
        self.document = document_of(stage)
        self.applied = Applied(self.renderer, self.document.state)
        self.extent = SceneExtent.of(stage.scene)
        self.fly = FlyCamera.at(stage.camera, self.extent.diagonal)
        self.rides = stage.camera_moves
        """Whether the scene moves the camera, until the user does."""
        self.clock = SceneClock()
        self.times = Measured()
        self.view = "final"
        self.drawn = 0
        self.shows_panel, self.shows_hud = preferences.shows_panel, preferences.shows_hud
        self.shows_help = self.shows_pixel = False
        self.frame: Frame | None = None
        self.problems: list[str] = []
        self.notices = Notices()
        self.pages = PageState()
        self.observers = Observers(device)
        self.images = ImageReader()
        self.thumbnails = Thumbnails(device)
        self.dialog: FileDialog | None = None
        self.window_acts: Callable[[str], None] = lambda _action: None
        """Does what only a window can."""
        self.remote: Remote | None = None
        self.job: SequenceJob | None = None
        """The frame sequence that is being rendered, or was last."""
        self._asked: list[str] = []
        self.place: Rect = (0.0, 0.0, *size)
        """Of the picture on the window, px from the top left corner."""
        self.cpu_ms = self.layout_ms = 0.0
        """Time of Python and of the driver's calls for the frame; for the panel's widgets."""
        self._began: float | None = None
        """When the last frame was begun."""
        gui.scale = preferences.scale
        self.workspace = Workspace(Widgets(gui.fonts, records), pages_of(self), preferences.layout)
        self.workspace.hidden.update(preferences.hidden)
        self._is_shown = False
        """Whether the panel has been drawn: before, it settles unseen."""
        self.notices.open(stage.scene)

    @property
    def preferences(self) -> Preferences:
        """What is kept for the next run."""
        return Preferences(
            layout=self.workspace.layout(),
            scale=self.gui.scale,
            shows_panel=self.shows_panel,
            shows_hud=self.shows_hud,
            hidden=sorted(self.workspace.hidden),
        )

    @property
    def camera(self) -> Camera:
        """Of the next frame, unless the scene moves it on."""
        return self.fly.camera()

    @property
    def eye_ws(self) -> tuple[float, float, float]:
        """Where the camera stands, m."""
        x, y, z = (float(f"{part:.4g}") for part in self.fly.position)
        return x, y, z

    @property
    def wants_mouse(self) -> bool:
        """Whether the mouse is the panel's or the gizmo's, not the camera's."""
        return self.gui.wants_mouse or (not self.gui.rests and gizmo_has_mouse())

    def draw(self, size: tuple[int, int], seconds: float) -> None:
        """Render a frame and show it on ``size`` pixels, the panel around it.

        ``seconds`` have passed since the one before, in the user's time.
        """
        began = time.perf_counter()
        self.times.update(
            self.device.timings, None if self._began is None else 1e3 * (began - self._began)
        )
        self._began = began
        self._follow()
        has_gui = self._has_gui
        area = (0, 0, *size)
        if has_gui:
            area = self._lay_out(size, seconds)
        else:
            self.gui.rest()
        laid_out = time.perf_counter()
        if not (self.gui.holds or (has_gui and gizmo_has_mouse())):
            self.document.settle()
        self._take_over()
        settled = time.perf_counter()
        if self.job is not None:
            actions.advance_job(self, self.job)  # before this frame, whose memory it may reuse
        drawing = time.perf_counter()
        self.renderer.resize((area[2], area[3]))
        if self.rides:
            self.fly.jump(self.stage.camera_at(self.clock.time_s))
        self.observers.before_frame(self.renderer)
        self.frame = self.renderer.render(
            self.fly.camera(), self.clock.time_s, self.drawn, self.view
        )
        self.observers.after_frame()
        self._show(area, size)
        presented = time.perf_counter()
        if has_gui:
            self.gui.draw()
        done = time.perf_counter()
        self.cpu_ms = 1e3 * (presented - drawing + settled - laid_out)
        self.layout_ms = 1e3 * (laid_out - began)
        self.times.panel_ms = 1e3 * (laid_out - began + done - presented)
        self.drawn += 1

    def tell(self, size: tuple[int, int]) -> None:
        """The panel once more around the newest frame, with what is only known after it."""
        self.device.finish()
        if self._began is not None:
            self.times.update(self.device.timings, 1e3 * (time.perf_counter() - self._began))
        self._follow()
        self.observers.catch_up()
        self._show(self._lay_out(size, 0.0), size)
        self.gui.draw()

    def _show(self, area: Area, size: tuple[int, int]) -> None:
        """The newest frame in its place."""
        assert self.frame is not None
        if area[2:] != size:
            self.device.clear_screen(theme.BACKDROP, self.onto)
        present(self.device, self.frame, area, self.onto)

    def _take_over(self) -> None:
        """Bring the renderer up to what was done in the panel, by menus, from elsewhere."""
        for broken in self.images.deliver():
            self.say(str(broken), "error")
        if self.document.problem is not None:
            self.say(str(self.document.problem), "error")
            self.document.problem = None
        self._act_on_menus()
        if self.remote is not None:
            self._take_over_remote(self.remote)
        try:
            if self.applied.take_over(self.document):
                reopening.reopen(self)
        except InputError as error:
            reopening.refuse(self, error)

    @property
    def _has_gui(self) -> bool:
        """Whether there is anything to draw over or around the picture."""
        shows = self.shows_panel or self.shows_hud or self.shows_help or self.shows_pixel
        return bool(shows or self.notices.message or self.dialog)

    def _lay_out(self, size: tuple[int, int], seconds: float) -> Area:
        """Make the widgets. Returns the picture's area, from the bottom left corner."""
        place: Rect = (0.0, 0.0, *size)
        while True:
            self.gui.begin(size, seconds)
            begin_gizmo()
            if self.shows_panel:
                place = self.workspace.draw(lambda w: menu_of(self, w))
            self.place = place
            overlays(self, place)
            if self.dialog is not None and self.dialog.draw(self.workspace.widgets):
                self.dialog = None
            if self.workspace.widgets.browsing is not None:
                actions.browse(self)
            self.gui.end()
            if self._is_shown or not self.shows_panel or self.workspace.is_settled:
                break
        self._is_shown = True
        left, top = max(round(place[0]), 0), max(round(place[1]), 0)
        right, bottom = min(round(place[2]), size[0]), min(round(place[3]), size[1])
        width, height = max(right - left, 1), max(bottom - top, 1)
        return min(left, size[0] - 1), max(size[1] - top - height, 0), width, height

    def _follow(self) -> None:
        """Take over edited shaders; what does not compile is told and its old program kept."""
        self.device.reload_changed_shaders()
        self.problems = self.renderer.problems()
        self.notices.follow(self.device.log.messages, self.problems)

    def act(self, action: str, index: int = 0, shift: bool = False) -> None:
        """What a binding or a menu item does; ``index`` tells which of the binding's keys."""
        if not actions.act(self, action, index, shift):
            self.window_acts(action)

    def menu_act(self, action: str) -> None:
        """Act once the widgets of this frame are made."""
        self._asked.append(action)

    def _take_over_remote(self, remote: Remote) -> None:
        """What is driven from elsewhere is in the document too: it can be seen and saved."""
        scene = self.stage.scene
        self.applied.take_over(self.document)
        remote.update(scene, self.renderer.settings)
        if tuple(scene.volumes) != self.document.state.volumes:
            self.document.amend_volumes(tuple(scene.volumes), "remote control")

    def _act_on_menus(self) -> None:
        asked, self._asked = self._asked, []
        for action in asked:
            self.act(action)

    def save_to(self, path: Path) -> None:
        """Write the scene's file."""
        actions.save_to(self, path)

    def may_lose_edits(self, how: str) -> bool:
        """Whether to go on with what drops the document: asked twice where that is unsaved."""
        question = f"unsaved edits would be lost: Ctrl+S saves them, {how} again drops them"
        return not self.document.would_be_lost or self.notices.confirms(question)

    def say(self, message: str, kind: Kind = "note") -> None:
        """Show a line for a while, and log it."""
        self.notices.say(message, kind)

    # The scene ---------------------------------------------------------------------------------

    def next_view(self, way: int) -> None:
        """Show the next buffer view."""
        names = list(VIEWS)
        self.show_view(names[(names.index(self.view) + way) % len(names)])

    def show_view(self, name: str) -> None:
        """Show one of VIEWS."""
        self.view = name
        self.say(f"{name}: {VIEWS[name]}")

    def open_saved(self, path: Path) -> None:
        """The scene is another file's from now on."""
        self.words = Words(str(path), [])
        self.stage.scene.path = path

    def show(self, stage: Stage) -> None:
        """Another scene, or the same one read again; the document is the caller's."""
        self.frame = None
        size = self.renderer.size
        self.renderer.release()
        self.stage = stage
        self.renderer = Renderer(self.device, stage.scene, stage.settings, size)
        self.renderer.spreads_gathers = True
        self.extent = SceneExtent.of(stage.scene)
        self.fly = replace(self.fly, diagonal=self.extent.diagonal)
        self.notices.open(stage.scene)

    def release(self) -> None:
        """Free the renderer and ImGui; the device is its maker's."""
        if self.job is not None:
            self.job.stop()
        self.observers.release()
        self.images.release()
        self.thumbnails.release()
        self.gui.release()
        self.renderer.release()
