"""Compares `scene_color` with a path-traced reference of the same scene: `tools/ground_truth -h`.

The scene, its camera, materials and lights go through the program's own loader, are converted for
mitsuba 3 (reference/mitsuba_scene.py, reference/bsdf.py: how light counts and materials map) and
path-traced to linear radiance. Ours comes from `elemental shot --view scene_color`.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from elemental.core.errors import InputError
from elemental.core.images import read_environment
from elemental.flag_values import Parser, join_vectors, number, size, vector, whole
from elemental.scene.deform import posed
from elemental.scene.evaluate import placed_camera
from elemental.scene.model import FloatArray
from elemental.session import Stage, Viewpoint, check_output, set_stage

try:
    import flip_evaluator  # noqa: F401  (what metrics.py measures with)
    import mitsuba as mi
except ImportError as missing:
    print(f"ground_truth: error: needs {missing.name}: pip install .[dev]", file=sys.stderr)
    sys.exit(2)

mi.set_variant("scalar_rgb")

from reference.cache import cached, fingerprint  # noqa: E402  (mitsuba first needs its variant)
from reference.metrics import compare, hdr_flip, noise, table, to_json  # noqa: E402
from reference.mitsuba_scene import Job, emission_mask, glass_mask, path_trace  # noqa: E402
from reference.sheet import sheet  # noqa: E402

OUT = Path(__file__).resolve().parent.parent / "out" / "ground_truth"


MOST_SAMPLES = 1 << 20
"""A pixel: hours on any machine, and well inside what mitsuba counts with."""


def _parser() -> Parser:
    parser = Parser(prog="tools/ground_truth", description=__doc__)
    parser.add_argument("scene", metavar="SCENE", help="a file or a scene's name, as for `shot`")
    flag = parser.flag
    flag("--size", "WxH", size, (320, 180), "pixels (320x180)")
    flag("--camera", "NAME", str, None, "a camera of the scene (its first)")
    flag("--eye", "X,Y,Z", vector, None, "camera position, metres")
    flag("--target", "X,Y,Z", vector, None, "point looked at, metres")
    flag("--fov", "DEG", number(1, 179), None, "vertical angle, degrees")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="a setting, repeatable"
    )
    flag("--time", "S", number(0, 1e6), 0.0, "scene time, s (0)")
    flag("--samples", "N", whole(1, 16), 1, "of ours along a side of a pixel (1)")
    flag("--spp", "N", whole(1, MOST_SAMPLES), 512, "samples a pixel (512)")
    flag("--ours", "FILE.exr", Path, None, "compare this picture")
    flag("--out", "STEM", Path, None, "STEM.png and STEM.json (out/ground_truth/SCENE)")
    return parser


def shoot(words: argparse.Namespace, stage: Stage) -> FloatArray:
    """Our `scene_color`, by the command line in a process of its own, seen from `stage.camera`.

    Each pixel is the mean of ``words.samples`` along either side, as the reference's is of more.
    """
    width, height = words.size
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "ours.exr"
        command = [sys.executable, "-m", "elemental", "shot", words.scene, "-o", str(output)]
        command += [
            "--view",
            "scene_color",
            "--size",
            f"{width * words.samples}x{height * words.samples}",
            "--time",
            str(words.time),
        ]
        if words.eye is not None:
            for flag, point in (("--eye", words.eye), ("--target", words.target)):
                command += [flag, ",".join(map(str, point))]
        elif stage.scene.cameras:
            command += ["--camera", stage.camera.name]
        if words.fov is not None:
            command += ["--fov", str(words.fov)]
        for assignment in words.set:
            command += ["--set", assignment]
        if subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode != 0:
            raise InputError("shot", "", "failed")
        fine = read_environment(output)
        parts = fine.reshape(height, words.samples, width, words.samples, -1)
        return np.asarray(parts.mean(axis=(1, 3)), np.float32)


def reference(
    stage: Stage, job: Job
) -> tuple[tuple[FloatArray, FloatArray], FloatArray, FloatArray]:
    """Two independent path-traced halves (H, W, 3), and the masks (H, W) of `emission_mask` and of
    `glass_mask`."""
    scene, camera = stage.scene, stage.camera
    content = (scene.meshes, scene.instances, scene.materials, scene.textures, scene.lights)
    content_key = fingerprint(*content, scene.environment, camera)
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def picture(kind: str, make: Callable[[Job], FloatArray], seed: int) -> FloatArray:
            half = replace(job, samples=max(job.samples // 2, 1), seed=seed)
            key = fingerprint(content_key, half, kind)
            return cached(OUT / "cache", key, lambda: make(half))

        first, second = (
            picture("radiance", lambda half: path_trace(scene, camera, half, folder), seed)
            for seed in (0, 1)
        )
        mask = picture("mask", lambda half: emission_mask(scene, camera, half, folder), 0)
        glass = mask * 0
        if any(material.transmits for material in scene.materials):
            glass = picture("glass", lambda half: glass_mask(scene, camera, half, folder), 0)
    print(f"reference in {time.monotonic() - start:.1f} s", file=sys.stderr)
    return (first, second), mask[..., 0], glass[..., 0]


def main() -> int:
    """Run, with one line for input that is wrong."""
    try:
        return run(_parser().parse_args(join_vectors(sys.argv[1:])))
    except InputError as error:
        print(f"ground_truth: error: {error}", file=sys.stderr)
        return 2


def run(words: argparse.Namespace) -> int:
    """Render, compare, write."""
    stem = words.out or OUT / Path(words.scene).stem
    if words.out is None:
        stem.parent.mkdir(parents=True, exist_ok=True)
    pictures = [stem.with_suffix(suffix) for suffix in (".png", ".json")]
    for file in pictures:
        check_output("--out", file, (file.suffix,))
    viewpoint = Viewpoint(words.camera, words.eye, words.target, words.fov)
    stage = set_stage(words.scene, words.set, viewpoint, words.size)
    camera = placed_camera(stage.scene, stage.camera, words.time)
    stage = replace(stage, camera=camera, scene=posed(stage.scene, words.time))
    settings = stage.settings
    bounces = int(settings["gi.bounces"]) if settings["gi.enabled"] else 0
    job = Job(words.size, words.spp, bounces, float(settings["sky.intensity"]))
    ours = shoot(words, stage) if words.ours is None else read_environment(words.ours)
    if ours.shape[1::-1] != words.size:
        found = "{}x{}".format(*ours.shape[1::-1])
        raise InputError(words.ours or "shot", "", f"is {found} pixels, --size says otherwise")
    halves, mask, glass = reference(stage, job)
    picture = (halves[0] + halves[1]) * np.float32(0.5)
    figures = {
        "scene": words.scene,
        "size": "{}x{}".format(*words.size),
        "camera": stage.camera.name,
        "time_s": words.time,
        "settings": words.set,
        "spp": words.spp,
        "bounces": bounces,
        "hdr_flip": hdr_flip(ours, picture),
        "all": compare(ours, picture, mask * 0 + 1),
        "surfaces": compare(ours, picture, mask),
        "glass": compare(ours, picture, glass),
        "reference_noise": noise(*halves, mask),
    }
    print(table(figures))
    title = " ".join([Path(words.scene).stem, *words.set])
    sheet(ours, picture, title).save(pictures[0])
    pictures[1].write_text(to_json(figures))
    print("\n".join(map(str, pictures)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
