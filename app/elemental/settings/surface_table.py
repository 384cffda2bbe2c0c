"""The rows of what works on the G-buffer: docs/surfaces.md."""

from __future__ import annotations

from elemental.settings.setting import Setting

SURFACE_TABLE = (
    Setting(
        "ao.intensity", "float", 0.5,
        "share of the screen-space ambient occlusion that darkens indirect light; 0 leaves it out",
        lo=0, hi=1, volume=True, source="[Mittring12]",
    ),
    Setting("ao.radius", "float", 2.0,
            "how far around a point things occlude it; two voxels at most where cones see the rest",
            unit="m", lo=0.001, hi=5, volume=True),
    Setting("ao.power", "float", 2.0, "exponent on the open share of the surroundings",
            lo=0.1, hi=8, volume=True),
    Setting("ao.bias", "float", 0.03, "height over the surface that occludes nothing",
            unit="m", lo=0, hi=0.1, volume=True),
    Setting("ao.fade_distance", "float", 80.0, "distance from the eye beyond which there is none",
            unit="m", lo=0, hi=200, volume=True),
    Setting("ao.fade_radius", "float", 50.0, "length before that over which it fades",
            unit="m", lo=0, hi=200, volume=True),
    Setting(
        "gbuffer.culling", "choice", "occlusion",
        "what is left out of the draws: nothing, what is outside the view, what others hide too; "
        "the picture is the same",
        choices=("none", "frustum", "occlusion"), source="[Greene93] [Wihlidal16]",
    ),
    Setting(
        "gbuffer.blur", "bool", True,
        "average normals and ambient occlusion over five pixels; broaden highlights to match",
        source="[Mittring12] [Toksvig05]",
    ),
)  # fmt: skip
