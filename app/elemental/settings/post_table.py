"""The rows of the post-processing effects."""

from __future__ import annotations

from elemental.settings.setting import Setting

POST_TABLE = (
    Setting(
        "exposure", "float", 0.0,
        "factor 2^exposure on scene radiance before the tone curve",
        unit="EV", lo=-16, hi=16, volume=True,
    ),
    Setting("fxaa.enabled", "bool", True, "edge antialiasing as the last filter",
            source="[Mittring12]"),
)  # fmt: skip
