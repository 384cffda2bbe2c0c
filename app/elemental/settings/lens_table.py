"""The rows of what happens in the lens: bloom, dirt, reflections, depth of field, motion blur."""

from __future__ import annotations

from elemental.settings.setting import Setting

# (default size, largest size) of the six bloom kernels, % of the picture's width.
_BLOOM = ((1.0, 8), (4.0, 16), (16.0, 32), (32.0, 64), (64.0, 128), (64.0, 128))


def _bloom_rows(number: int, size: float, largest: float) -> tuple[Setting, Setting]:
    return (
        Setting(f"bloom.size{number}", "float", size, "diameter of this bloom kernel",
                unit="% of the width", lo=0, hi=largest, source="[Mittring12]", volume=True),
        Setting(f"bloom.tint{number}", "color", (0.5, 0.5, 0.5), "factor on this bloom kernel",
                lo=0, hi=1, volume=True),
    )  # fmt: skip


# (tint, position) of the eight reflections; the positions are the field's, the tints ours.
_FLARES = (
    ((1.0, 0.7, 0.4), 0.60), ((1.0, 0.95, 0.6), 0.53), ((0.6, 0.8, 1.0), 0.46),
    ((0.5, 1.0, 0.6), 0.39), ((0.4, 0.7, 1.0), 0.31), ((0.9, 0.6, 1.0), 0.27),
    ((1.0, 0.6, 0.35), 0.22), ((0.7, 0.85, 1.0), 0.15),
)  # fmt: skip


def _flare_rows(
    number: int, tint: tuple[float, float, float], position: float
) -> tuple[Setting, Setting]:
    return (
        Setting(f"lens_flare.tint{number}", "color", tint, "factor on this reflection",
                lo=0, hi=1, volume=True),
        Setting(f"lens_flare.position{number}", "float", position,
                "place and size of this reflection: 0.5 the centre, 0.25 the mirrored picture",
                lo=0, hi=1, volume=True),
    )  # fmt: skip


LENS_TABLE = (
    Setting("bloom.intensity", "float", 1.0, "share of bright light that is spread; 0: no bloom",
            lo=0, hi=8, source="[Mittring12]", volume=True),
    Setting("bloom.threshold", "float", 1.0,
            "exposed luminance above which light is spread; below 0: all of it",
            lo=-1, hi=8, source="[Mittring12]", volume=True),
    *(row for number, sizes in enumerate(_BLOOM, 1) for row in _bloom_rows(number, *sizes)),
    Setting("bloom.dirt_mask", "text", "",
            "where bloom lights up dirt on the lens: an image or one of content/textures/; "
            "empty: none", unit="file", source="[Mittring12]", volume=True),
    Setting("bloom.dirt_intensity", "float", 1.0, "factor on that dirt", lo=0, hi=8, volume=True),
    Setting("bloom.dirt_tint", "color", (0.5, 0.5, 0.5), "tint of that dirt",
            lo=0, hi=1, volume=True),
    Setting("lens_flare.intensity", "float", 0.25,
            "factor on reflections in the lens; 0: none", lo=0, hi=16, source="[Mittring12]",
            volume=True),
    Setting("lens_flare.threshold", "float", 8.0,
            "exposed luminance above which light is reflected",
            lo=0.1, hi=32, source="[Mittring12]", volume=True),
    Setting("lens_flare.bokeh_size", "float", 3.0, "diameter of a bright pixel's sprite",
            unit="% of the width", lo=0, hi=32, source="[Mittring12]", volume=True),
    Setting("lens_flare.bokeh_shape", "text", "bokeh_hexagon.png",
            "that sprite: an image or one of content/textures/; empty: no reflections",
            unit="file", source="[Mittring12]", volume=True),
    Setting("lens_flare.tint", "color", (1.0, 1.0, 1.0), "factor on all reflections",
            lo=0, hi=1, volume=True),
    *(row for number, flare in enumerate(_FLARES, 1) for row in _flare_rows(number, *flare)),
    # Off by default: what is in focus is a scene's or a shot's to say.
    Setting("dof.enabled", "bool", False, "depth of field", volume=True),
    Setting("dof.focal_distance", "float", 1000.0, "distance along the view that is sharp",
            unit="cm", lo=1, hi=10000, volume=True),
    Setting("dof.f_stop", "float", 4.0, "focal length over aperture: divides the size of the blur",
            lo=1, hi=32, volume=True),
    Setting("dof.near_transition", "float", 300.0,
            "how far before the focus the blur is fully grown",
            unit="cm", lo=0, hi=10000, volume=True),
    Setting("dof.far_transition", "float", 500.0,
            "how far behind the focus the blur is fully grown",
            unit="cm", lo=0, hi=10000, volume=True),
    Setting("dof.max_bokeh_size", "float", 15.0, "diameter of the fully grown blur at f/1",
            unit="% of the width", lo=0, hi=32, volume=True),
    # Off by default: a still and a frame of a moving scene then show the same.
    Setting("motion_blur.amount", "float", 0.0,
            "share of the time between two frames that the shutter is open; 0.5 is a film's",
            lo=0, hi=1, volume=True),
    Setting("motion_blur.max", "float", 5.0, "longest streak",
            unit="% of the width", lo=0, hi=50, volume=True),
)  # fmt: skip
