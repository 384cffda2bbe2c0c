"""What is told of a frame's targets: which there are, their shape, their memory."""

from __future__ import annotations

from collections import Counter

from elemental.gpu.graph_report import GraphReport, GraphResource
from elemental.passes.inspect import Target

KIB = 1024


def targets_of(report: GraphReport) -> list[tuple[Target, GraphResource]]:
    """The textures of a frame, in the order in which they are first used."""
    seen: Counter[tuple[str, tuple[int, ...], str]] = Counter()
    found = []
    for resource in sorted(report.resources, key=lambda r: r.first_pass):
        if resource.kind == "texture":
            key = (resource.name, resource.size, resource.format)
            found.append((Target(*key, seen[key]), resource))
            seen[key] += 1
    return found


def title_of(target: Target) -> str:
    """A target's name, numbered where the frame has several of that name."""
    return f"{target.name} #{target.occurrence + 1}" if target.occurrence else target.name


def describe(resource: GraphResource) -> str:
    """``320x180 RGBA16F, 450 KiB``."""
    if resource.kind == "buffer":
        return f"buffer, {resource.nbytes / KIB:,.1f} KiB"
    size = "x".join(map(str, resource.size))
    layers = f" ({resource.layers} layers)" if resource.layers > 1 else ""
    mips = f", {resource.mips} levels" if resource.mips > 1 else ""
    return f"{size}{layers} {resource.format}{mips}, {resource.nbytes / KIB:,.0f} KiB"


def memory_facts(target: Target, report: GraphReport) -> list[tuple[str, str]]:
    """What a target takes, how long that is held and how often it was reused; the whole pool."""
    found = dict(targets_of(report)).get(target)
    if found is None:
        return []
    facts = [("takes", f"{found.nbytes / KIB:,.0f} KiB")]
    held = next((one for one in report.pool.held if one.memory == found.memory), None)
    if held is None:
        facts.append(("", "not of the pool"))
    else:
        facts += [("age", f"{held.age:,}"), ("reused", f"{held.reuses:,}")]
    return [
        *facts,
        ("pool", f"{report.pool.bytes / KIB**2:.1f} MiB"),
        ("at most", f"{report.pool.high_water / KIB**2:.1f} MiB"),
    ]
