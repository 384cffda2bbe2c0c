"""How far a picture is from its reference: linear radiance in, numbers out."""

from __future__ import annotations

import json
from typing import Any

import flip_evaluator
import numpy as np

from elemental.scene.model import FloatArray

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)
"""Rec. 709 weights."""

PERCENTILES = (10, 50, 90, 99)

FLOOR = 0.01
"""Relative errors divide by the reference's luminance, but at least by this part of its mean."""


def relative_error(ours: FloatArray, reference: FloatArray) -> FloatArray:
    """Signed error of the luminance over the reference's, (H, W)."""
    ours_y, reference_y = ours @ LUMINANCE, reference @ LUMINANCE
    floor = FLOOR * float(reference_y.mean()) + 1e-12
    return np.asarray((ours_y - reference_y) / np.maximum(reference_y, floor))


def compare(ours: FloatArray, reference: FloatArray, mask: FloatArray) -> dict[str, Any]:
    """Every figure over the pixels where `mask` (H, W) is 1; images (H, W, 3) linear radiance."""
    chosen = mask > 0.0
    if not chosen.any():
        return {"pixels": 0}
    a, b = ours[chosen], reference[chosen]
    error = relative_error(a, b)
    energy = a.sum(axis=0, dtype=np.float64) / np.maximum(b.sum(axis=0, dtype=np.float64), 1e-12)
    total = float((a @ LUMINANCE).sum(dtype=np.float64) / (b @ LUMINANCE).sum(dtype=np.float64))
    return {
        "pixels": int(chosen.sum()),
        "rmse": float(np.sqrt(np.mean((a - b) ** 2, dtype=np.float64))),
        "mean_reference": float(b.mean(dtype=np.float64)),
        "relative_error": {f"p{p}": float(np.percentile(np.abs(error), p)) for p in PERCENTILES},
        "signed_relative_error_median": float(np.median(error)),
        "energy_ratio": total,
        "energy_ratio_rgb": [float(e) for e in energy],
    }


def noise(first: FloatArray, second: FloatArray, mask: FloatArray) -> dict[str, float]:
    """Relative error that the mean of two independent halves still has by itself, by percentile.

    Their half difference has the deviation of their mean.
    """
    mean = 0.5 * (first + second)
    error = np.abs(relative_error(first, mean))[mask > 0.0]
    return {f"p{p}": float(np.percentile(error, p)) if error.size else 0.0 for p in PERCENTILES}


def hdr_flip(ours: FloatArray, reference: FloatArray) -> float:
    """Mean HDR-FLIP [Andersson21] over the whole picture, 0 (equal) to 1."""
    _, mean, _ = flip_evaluator.evaluate(
        np.ascontiguousarray(np.maximum(reference, 0.0)),
        np.ascontiguousarray(np.maximum(ours, 0.0)),
        "HDR",
    )
    return float(mean)


def table(figures: dict[str, Any]) -> str:
    """The figures as lines for a terminal."""
    floor = "  ".join(f"{p} {v:.1%}" for p, v in figures["reference_noise"].items())
    lines = [f"HDR-FLIP {figures['hdr_flip']:.4f}", f"reference's own noise   {floor}"]
    for name in ("all", "surfaces", "glass"):
        f = figures[name]
        if not f["pixels"]:
            continue
        error = "  ".join(f"{p} {v:.1%}" for p, v in f["relative_error"].items())
        rgb = " ".join(f"{e:.3f}" for e in f["energy_ratio_rgb"])
        lines += [
            f"{name} ({f['pixels']} pixels)",
            f"  RMSE                {f['rmse']:.5f} (reference mean {f['mean_reference']:.5f})",
            f"  |relative error|    {error}",
            f"  signed median       {f['signed_relative_error_median']:+.1%}",
            f"  total energy ratio  {f['energy_ratio']:.3f} (RGB {rgb})",
        ]
    return "\n".join(lines)


def to_json(figures: dict[str, Any]) -> str:
    """The figures as an indented JSON text."""
    return json.dumps(figures, indent=2) + "\n"
