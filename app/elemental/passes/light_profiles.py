"""Photometric profiles of the lights as layers of one texture array."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from elemental.gpu.device import Device
from elemental.gpu.formats import R16F
from elemental.gpu.refs import Ref, Sampled
from elemental.gpu.resources import Texture
from elemental.scene.ies import LightProfile
from elemental.scene.model import Light

SIZE = (64, 256)
"""Texels round the axis and from pole to pole: 0.7 degrees a row, finer than files are."""


def profiles_of(lights: Sequence[Light]) -> list[LightProfile]:
    """Each profile that any of the lights has, once."""
    return list({id(light.profile): light.profile for light in lights if light.profile}.values())


class LightProfiles:
    """The texture `u_light_profiles` of lib/lights.glsl; `revision` counts its contents."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._held: list[LightProfile] = []
        self._texture: Texture | None = None
        self.revision = 0

    def update(self, profiles: Sequence[LightProfile]) -> None:
        """Hold these, uploaded anew where they are others than before."""
        same = len(profiles) == len(self._held)
        same &= all(a is b for a, b in zip(profiles, self._held, strict=False))
        if same and self._texture is not None:
            return
        self.release()
        self._held = list(profiles)
        self.revision += 1
        size = SIZE if profiles else (1, 1)
        texels = np.ones((max(len(profiles), 1), size[1], size[0]), np.float16)
        for layer, profile in enumerate(profiles):
            texels[layer] = profile.image(*size)
        self._texture = self._device.texture(
            "lights.profiles", size, R16F, layers=len(texels), data=texels
        )

    def reads(self) -> dict[str, Ref]:
        """What lib/lights.glsl samples."""
        assert self._texture is not None, "update comes first"
        sampled = Sampled(self._texture, filter="linear", wrap=("repeat", "clamp"))
        return {"u_light_profiles": sampled}

    def release(self) -> None:
        """Free the texture."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None
