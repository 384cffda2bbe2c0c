"""Measures the scenes of tests/accuracy and rewrites their table; look at what got worse.

python tools/update_accuracy.py [NAME…]                  the figures of these cases, or of all
python tools/update_accuracy.py --references [NAME…]     path-trace their pictures first (mitsuba)

`--dry` prints and writes nothing; `--set KEY=VALUE` measures with other settings, as `--dry`. What
fell behind stays as it was in the table unless `--worse` takes it over.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "app")]

from accuracy import ratchet  # type: ignore[import-not-found]  # noqa: E402
from elemental.gpu.device import Device  # noqa: E402

SAMPLES = 4096
"""Paths a pixel, in halves of the seeds 0 and 1: their difference says how noisy their mean is."""


def path_trace(case: Any) -> dict[str, Any]:
    """Write the case's reference; how it was made and its own noise."""
    import mitsuba  # noqa: PLC0415 (a development dependency that only this needs)

    mitsuba.set_variant("scalar_rgb")
    from reference.metrics import noise  # noqa: PLC0415
    from reference.mitsuba_scene import Job, emission_mask, glass_mask  # noqa: PLC0415
    from reference.mitsuba_scene import path_trace as trace  # noqa: PLC0415

    stage = case.stage()
    factor = float(stage.settings["sky.intensity"])
    job = Job(case.size, SAMPLES // 2, ratchet.GATHERS, factor)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        halves = [
            trace(stage.scene, stage.camera, replace(job, seed=seed), folder) for seed in (0, 1)
        ]
        look = glass_mask if case.glass else emission_mask
        mask = look(stage.scene, stage.camera, job, folder)[..., 0]
    ratchet.write_reference(case.file, 0.5 * (halves[0] + halves[1]), mask)
    own = noise(halves[0], halves[1], mask)
    return {
        "samples": SAMPLES,
        "seeds": [0, 1],
        "gathers": ratchet.GATHERS,
        "noise_p50": round(own["p50"], 4),
        "noise_p90": round(own["p90"], 4),
    }


def main() -> None:
    """Trace where asked to, measure, print beside the table, write."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(ratchet.CASES))
    parser.add_argument("--references", action="store_true")
    parser.add_argument("--dry", action="store_true")
    parser.add_argument("--worse", action="store_true")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    words = parser.parse_args()
    names = words.names or list(ratchet.CASES)
    table = ratchet.reached() if ratchet.TABLE.is_file() else {"cases": {}, "references": {}}
    if words.references:
        for name in dict.fromkeys(ratchet.CASES[name].reference for name in names):
            table["references"][name] = path_trace(ratchet.CASES[name])
            print(name, table["references"][name], flush=True)
            write(table)
    device = Device.headless(debug=True)
    for name in names:
        case = ratchet.CASES[name]
        case = replace(case, settings=(*case.settings, *words.set))
        now = ratchet.figures(ratchet.draw(device, case), *ratchet.read_reference(case.file))
        before = table["cases"].get(name, now)
        line = "  ".join(f"{key} {before[key]:+.4f} -> {now[key]:+.4f}" for key in now)
        print(f"{name:20s} {line}  {'WORSE' if ratchet.worse(now, before) else ''}", flush=True)
        kept = now if words.worse else {k: min(now[k], before[k], key=abs) for k in now}
        table["cases"][name] = {key: round(value, 4) for key, value in kept.items()}
    if not (words.dry or words.set):
        write(table)


def write(table: dict[str, Any]) -> None:
    """Replace the committed table."""
    ratchet.TABLE.write_text(json.dumps(table, indent=2) + "\n")


if __name__ == "__main__":
    main()
