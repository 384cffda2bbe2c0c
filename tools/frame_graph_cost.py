#!/usr/bin/env python3
"""CPU cost of the frame graph: microseconds of Python a pass, with and without the driver.

    tools/frame_graph_cost.py [--passes 60] [--frames 1000] [--endurance N]

Each pass is of middling size: three samplers, a storage buffer, an image, two uniform blocks.
"without the driver" replaces every GL call by an empty function, so it is the Python alone (the
budget is 10 µs); "with" adds the driver's share, on dispatches of no groups.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from driverless import without_driver
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.gpu.shaders import Compute, Raster

BINDINGS = """
uniform sampler2D u_a; uniform sampler2D u_b; uniform sampler2D u_c;
layout(std430) readonly buffer Values { vec4 values[]; };
layout(std140) uniform First { vec4 first; };
layout(std140) uniform Second { vec4 second; };
vec4 all() { return texelFetch(u_a, ivec2(0), 0) + texelFetch(u_b, ivec2(0), 0)
    + texelFetch(u_c, ivec2(0), 0) + values[0] + first + second; }
"""
COMPUTE = f"""layout(local_size_x = 8, local_size_y = 8) in;
{BINDINGS}
layout(rgba16f) writeonly uniform image2D o_image;
void main() {{ imageStore(o_image, ivec2(gl_GlobalInvocationID.xy), all()); }}
"""
VERTEX = "void main() { gl_Position = vec4(0.0); }\n"
FRAGMENT = f"{BINDINGS}\nout vec4 o_color;\nvoid main() {{ o_color = all(); }}\n"
SIZE = (16, 16)


class Workload:
    """Frames of ``passes`` passes, compute and raster in turn, each reading the ones before."""

    def __init__(self, device: Device, folder: Path, passes: int) -> None:
        self.device, self.passes = device, passes
        for name, text in (("c.comp", COMPUTE), ("v.vert", VERTEX), ("f.frag", FRAGMENT)):
            (folder / f"{name}.glsl").write_text(text)
        self.compute = Compute(folder / "c.comp.glsl")
        self.raster = Raster(folder / "v.vert.glsl", folder / "f.frag.glsl")
        self.values = device.buffer("values", np.zeros(16, np.float32))
        self.params = {"First": np.zeros((), [("x", "f4", 4)]), "Second": np.ones((), "4f4")}

    def declare(self) -> Graph:
        """A frame, not yet run."""
        graph = self.device.begin_frame()
        images = []
        for index in range(3):
            images.append(graph.texture(f"start {index}", SIZE, RGBA16F))
            graph.clear_texture(images[-1])
        for index in range(self.passes):
            target = graph.texture(f"target {index}", like=images[-1])
            a, b, c = images[-3:]
            reads: dict[str, Ref] = {"u_a": a, "u_b": b, "u_c": c, "Values": self.values}
            if index % 2:
                graph.compute(
                    self.compute, reads=reads, writes={"o_image": target}, params=self.params,
                    groups=(0, 1, 1),
                )  # fmt: skip
            else:
                graph.raster(self.raster, color=target, reads=reads, params=self.params, vertices=0)
            images.append(target)
        graph.keep(images[-1])
        return graph

    def measure(self, frames: int) -> tuple[float, float]:
        """(declaring, running) in µs a pass: of ten runs, the one with the lowest medians.

        What else the machine does only ever adds.
        """
        runs = [self._medians(max(1, frames // 10)) for _ in range(10)]
        return min(runs, key=sum)

    def _medians(self, frames: int) -> tuple[float, float]:
        declared, ran = [], []
        for _ in range(frames):
            start = time.perf_counter()
            graph = self.declare()
            middle = time.perf_counter()
            graph.execute()
            end = time.perf_counter()
            declared.append(middle - start)
            ran.append(end - middle)
        scale = 1e6 / (self.passes + 3)
        return median(declared) * scale, median(ran) * scale


def endure(workload: Workload, frames: int) -> None:
    """Print the resident memory along ``frames`` frames (Linux)."""
    for frame in range(frames + 1):
        workload.declare().execute()
        if frame in {frames // 50, frames // 2, frames}:
            pages = int(Path("/proc/self/statm").read_text().split()[1])
            print(f"after {frame:6} frames: {pages * 4096 / 1e6:.1f} MB resident")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--passes", type=int, default=60)
    parser.add_argument("--frames", type=int, default=1000)
    parser.add_argument("--endurance", type=int, metavar="N", help="print memory over N frames")
    options = parser.parse_args()
    device = Device.headless()
    with tempfile.TemporaryDirectory() as folder:
        workload = Workload(device, Path(folder), options.passes)
        if options.endurance:
            endure(workload, options.endurance)
            return
        workload.measure(10)
        driver = workload.measure(options.frames)
        device.finish()
        with without_driver(device):
            python = workload.measure(options.frames)
    print(f"{device.info.renderer}; {options.passes} passes a frame, µs a pass")
    for name, (declare, run) in (("without the driver", python), ("with the driver", driver)):
        print(f"{name:20} declare {declare:6.2f}  run {run:6.2f}  sum {declare + run:6.2f}")


if __name__ == "__main__":
    main()
