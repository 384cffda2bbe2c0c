"""CPU cost of blending volumes: microseconds a frame, `python tools/volume_cost.py`."""

from __future__ import annotations

import timeit

from elemental.scene.volumes import Volume, blend
from elemental.settings import SETTINGS, Settings

VOLUMES = 8
OVERRIDES = 10
FRAMES = 2000
REPEATS = 5


def main() -> None:
    """A line for no volumes, for volumes out of reach and for volumes at work."""
    keys = [setting for setting in SETTINGS.values() if setting.volume][:OVERRIDES]
    overrides = {setting.key: setting.default for setting in keys}
    near = [
        Volume(f"v{k}", rotation_deg=(0.0, 30.0, 0.0), blend_weight=0.5, overrides=overrides)
        for k in range(VOLUMES)
    ]
    far = [Volume(f"v{k}", center=(50.0, 0.0, 0.0), overrides=overrides) for k in range(VOLUMES)]
    base = Settings()
    for name, volumes in (("none", []), ("out of reach", far), ("at work", near)):
        times = timeit.repeat(
            lambda volumes=volumes: blend(base, volumes, (0.0, 0.1, 0.0)),  # type: ignore[misc]
            number=FRAMES,
            repeat=REPEATS,
        )
        print(f"{name:12s} {min(times) / FRAMES * 1e6:7.2f} µs")


if __name__ == "__main__":
    main()
