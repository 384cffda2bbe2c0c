"""Which pages the panel has, and what of the desk each of them is given."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from elemental.frame import VIEWS
from elemental.scene.volumes import blend
from elemental.ui import actions
from elemental.ui.gui import SCALES
from elemental.ui.hud import Figures, draw_hud, draw_keys, draw_message, draw_pixel
from elemental.ui.image_choice import choose_image, put_image_back
from elemental.ui.in_view import Lens, draw_gizmo, draw_volumes
from elemental.ui.panel.buffers import BufferView, buffers_page
from elemental.ui.panel.exposure import exposure_page
from elemental.ui.panel.graph import GraphView, graph_page
from elemental.ui.panel.image_row import Images
from elemental.ui.panel.lights import lights_page
from elemental.ui.panel.log import COLORS, LogFilter, log_page
from elemental.ui.panel.materials import materials_page
from elemental.ui.panel.menu import MenuState, menu_bar
from elemental.ui.panel.regions import RegionView, as_box, from_box, regions_page
from elemental.ui.panel.scene import Selection, scene_page
from elemental.ui.panel.sequence import DEFAULT, sequence_page
from elemental.ui.panel.settings import settings_page
from elemental.ui.panel.textures import MaterialImages
from elemental.ui.panel.timeline import ms_text, timeline_page
from elemental.ui.panel.volumes import VolumeView, volumes_page
from elemental.ui.sequence_job import SequenceWords
from elemental.ui.widgets import Widgets
from elemental.ui.words import Rect
from elemental.ui.workspace import Page

if TYPE_CHECKING:
    from elemental.ui.desk import Desk


@dataclass
class PageState:
    """What the pages keep from frame to frame."""

    settings: str = ""
    """What is searched for."""
    scene: str = ""
    selection: Selection | None = None
    log: LogFilter = field(default_factory=LogFilter)
    buffers: BufferView = field(default_factory=BufferView)
    graph: GraphView = field(default_factory=GraphView)
    volumes: VolumeView = field(default_factory=VolumeView)
    regions: RegionView = field(default_factory=RegionView)
    material: int = 0
    light: int = 0
    sequence: SequenceWords = DEFAULT


def pages_of(desk: Desk) -> list[Page]:
    """The pages over a desk, in the order of their tabs."""
    state, observers = desk.pages, desk.observers

    def scene(w: Widgets) -> None:
        opened, parts = desk.stage.scene, desk.document.state
        choose = partial(actions.choose, desk)
        state.scene = scene_page(
            w, opened, desk.extent, parts, state.selection, state.scene, choose
        )

    def settings(w: Widgets) -> None:
        state.settings = settings_page(w, desk.document, state.settings)

    def volumes(w: Widgets) -> None:
        observers.want("volumes")
        eye = desk.eye_ws
        weights = [volume.weight(eye) for volume in desk.document.state.volumes]
        volumes_page(w, state.volumes, desk.document, weights, eye)

    def materials(w: Widgets) -> None:
        scene = desk.stage.scene
        projected = frozenset(decal.material for decal in scene.decals)
        images = MaterialImages(images_of(desk), scene.textures, projected)
        state.material = materials_page(w, state.material, desk.document, images)

    def lights(w: Widgets) -> None:
        environment, images = desk.stage.scene.environment, images_of(desk)
        state.light = lights_page(w, state.light, desk.document, environment, images)

    def regions(w: Widgets) -> None:
        observers.want("regions")
        regions_page(w, state.regions, desk.document, (desk.extent.low, desk.extent.high))

    def exposure(w: Widgets) -> None:
        observers.want("eye")
        parts = desk.document.state
        exposure_page(w, observers.eye, blend(parts.settings, parts.volumes, desk.eye_ws))

    def sequence(w: Widgets) -> None:
        state.sequence = sequence_page(w, state.sequence, desk.job, desk.menu_act)

    def timeline(w: Widgets) -> None:
        timeline_page(w, desk.times.times())

    def graph(w: Widgets) -> None:
        observers.want("report")
        asked = graph_page(w, state.graph, observers.report)
        if asked is not None:
            actions.look_at(desk, asked)

    def buffers(w: Widgets) -> None:
        observers.want("report")
        observers.want("buffer")
        save = partial(actions.save_buffer, desk)
        buffers_page(w, state.buffers, observers.inspector, observers.report, save)

    def log(w: Widgets) -> None:
        log_page(w, desk.notices.log, state.log)

    return [
        Page("Scene", "left", scene),
        Page("Settings", "right", settings),
        Page("Volumes", "right", volumes),
        Page("Materials", "right", materials),
        Page("Lights", "right", lights),
        Page("Regions", "right", regions),
        Page("Timeline", "bottom", timeline),
        Page("Graph", "bottom", graph),
        Page("Buffers", "bottom", buffers),
        Page("Exposure", "bottom", exposure),
        Page("Sequence", "bottom", sequence),
        Page("Log", "bottom", log),
    ]


def images_of(desk: Desk) -> Images:
    """Images of materials and lights, as their rows take them."""
    return Images(
        desk.stage.scene.path.parent,
        lambda key, image: desk.thumbnails.of(key, image).glo,
        partial(choose_image, desk),
        partial(put_image_back, desk),
        desk.images.is_reading,
        desk.images.problems.get,
    )


def menu_of(desk: Desk, w: Widgets) -> None:
    """The menu bar over a desk."""
    document, workspace = desk.document, desk.workspace
    frame_ms = desk.times.frame_ms
    held = sum(desk.device.bytes().values()) / 2**20
    state = MenuState(
        scene=desk.stage.scene.name,
        unsaved=document.unsaved,
        undo=document.undo_label,
        redo=document.redo_label,
        view=desk.view,
        views=VIEWS,
        pages=[page.name for page in workspace.pages],
        hidden=frozenset(workspace.hidden),
        scale=desk.gui.scale,
        scales=SCALES,
        figures=f"{ms_text(frame_ms)}    {held:,.0f} MiB",
    )
    menu_bar(w, state, desk.menu_act)


def overlays(desk: Desk, place: Rect) -> None:
    """What stands over the picture."""
    if desk.observers.wants("volumes"):
        _volumes_in_view(desk, place)
    elif desk.observers.wants("regions"):
        _regions_in_view(desk, place)
    if desk.shows_pixel:
        _pixel_in_view(desk, place)
    if desk.shows_hud and not desk.shows_help and desk.frame is not None:
        draw_hud(figures_of(desk), place, desk.gui.fonts)
    if desk.shows_help:
        draw_keys()
    if desk.notices.message:
        draw_message(desk.notices.message, place, COLORS[desk.notices.kind])


def _volumes_in_view(desk: Desk, place: Rect) -> None:
    """Outlines of the volumes, and the gizmo on the chosen one."""
    view, document = desk.pages.volumes, desk.document
    volumes = document.state.volumes
    lens = Lens.of(desk.camera, (desk.extent.low, desk.extent.high), place)
    draw_volumes(lens, volumes, view.chosen)
    if view.chosen < len(volumes) and not volumes[view.chosen].unbound:
        dragged = draw_gizmo(lens, volumes[view.chosen], view.gizmo)
        if dragged is not None:
            document.set_volume(view.chosen, dragged, ("gizmo", view.chosen))


def _regions_in_view(desk: Desk, place: Rect) -> None:
    """Outlines of the regions, and the gizmo on the chosen one."""
    view, document = desk.pages.regions, desk.document
    regions = document.state.regions
    lens = Lens.of(desk.camera, (desk.extent.low, desk.extent.high), place)
    boxes = [as_box(region, number) for number, region in enumerate(regions)]
    draw_volumes(lens, boxes, view.chosen)
    if view.chosen < len(regions):
        dragged = draw_gizmo(lens, boxes[view.chosen], view.gizmo)
        if dragged is not None:
            moved = from_box(dragged, regions[view.chosen].level_offset)
            document.set_region(view.chosen, moved, ("gizmo", view.chosen))


def _pixel_in_view(desk: Desk, place: Rect) -> None:
    """The pixel inspector, while the mouse is over the picture."""
    mouse = imgui.get_mouse_pos()
    across = (mouse.x - place[0]) / max(place[2] - place[0], 1.0)
    down = (mouse.y - place[1]) / max(place[3] - place[1], 1.0)
    if not (0.0 <= across < 1.0 and 0.0 <= down < 1.0):
        return
    pixel = desk.observers.pixel
    pixel.place = (across, 1.0 - down)
    desk.observers.want("pixel")
    if pixel.values:
        draw_pixel(pixel.values, place, desk.gui.fonts)


def figures_of(desk: Desk) -> Figures:
    """What the HUD tells of the last frame."""
    settings = desk.renderer.settings
    frame = desk.frame
    return Figures(
        scene=desk.stage.scene.name,
        driver=desk.device.info.renderer,
        view=desk.view,
        size=desk.renderer.size,
        voxels=settings["gi.resolution"] if settings["gi.enabled"] else 0,
        frame_ms=desk.times.frame_ms,
        cpu_ms=desk.cpu_ms,
        passes=dict(desk.times.gpu.values),
        counters=frame.counters if frame is not None else {},
        bytes=desk.device.bytes(),
        time_s=desk.clock.time_s,
        paused=desk.clock.paused,
        speed=desk.fly.speed,
        problems=desk.problems,
    )
