"""How a pass refers to a resource: transient handles, and words for how it is looked at."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING, NamedTuple

from elemental.gpu import gl as c
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shape import Shaped, TextureDesc

if TYPE_CHECKING:
    from elemental.gpu.graph import Graph


class TextureHandle(Shaped):
    """A transient texture of one frame; ``physical`` is set while the graph runs.

    A kept handle's ``physical`` stays valid until the device's next ``begin_frame``. Frames that
    declare alike are given the same handles; ``graph`` is the frame that a handle is of.
    """

    __slots__ = ("graph", "physical")

    def __init__(self, name: str, desc: TextureDesc) -> None:
        self.name, self.desc = name, desc
        self.graph: Graph | None = None
        self.physical: Texture | None = None

    @property
    def description(self) -> Hashable:
        """By what the pool finds memory for it."""
        return self.desc


class BufferHandle:
    """A transient buffer of one frame."""

    __slots__ = ("graph", "name", "nbytes", "physical")

    def __init__(self, name: str, nbytes: int) -> None:
        self.name, self.nbytes = name, nbytes
        self.graph: Graph | None = None
        self.physical: Buffer | None = None

    @property
    def description(self) -> Hashable:
        """By what the pool finds memory for it."""
        return self.nbytes


AnyTexture = Texture | TextureHandle
AnyBuffer = Buffer | BufferHandle
AnyHandle = TextureHandle | BufferHandle
Resource = AnyTexture | AnyBuffer

# The words below are tuples, which compare and hash by their parts: what a pass uses is found by
# them again in the frames that follow.


class Sampled(NamedTuple):
    """A texture with an explicit way of sampling.

    ``filter``: nearest, linear (level 0 unless the shader names a level; never between levels),
    trilinear. ``wrap``: one word or one for each of u and v: clamp, repeat, mirror, border.
    ``compare``: depth comparison (less or equal), for shadow samplers. ``border``: the value beyond
    the edge with wrap="border". ``stencil``: sample the stencil of a D24S8 texture (usampler).
    """

    texture: AnyTexture | Mip | Layer
    filter: str | None = None
    wrap: str | tuple[str, str] = "clamp"
    compare: bool = False
    border: float = 0.0
    anisotropy: float = 1.0
    stencil: bool = False


class Mip(NamedTuple):
    """One mip level of a texture, for sampling, image access or as a render target."""

    texture: AnyTexture
    level: int


class Layer(NamedTuple):
    """One layer, slice or cube face (layer*6 + face) of one level of a texture."""

    texture: AnyTexture
    layer: int
    level: int = 0


class Unordered(NamedTuple):
    """A buffer as passes write it in whatever order: atomics, or the same value by all.

    Such passes don't wait for each other; all that reads it waits for them.
    """

    buffer: AnyBuffer


ImageRef = AnyTexture | Mip | Layer
TextureRef = ImageRef | Sampled
Ref = TextureRef | AnyBuffer | Unordered | tuple[TextureRef, ...]

_FILTERS = {
    "nearest": (c.NEAREST, c.NEAREST),
    "linear": (c.LINEAR, c.LINEAR),
    "trilinear": (c.LINEAR_MIPMAP_LINEAR, c.LINEAR),
    "nearest_mip": (c.NEAREST_MIPMAP_NEAREST, c.NEAREST),
}
_WRAPS = {
    "clamp": c.CLAMP_TO_EDGE,
    "repeat": c.REPEAT,
    "mirror": c.MIRRORED_REPEAT,
    "border": c.CLAMP_TO_BORDER,
}
SamplerKey = tuple[str, str | tuple[str, str], bool, float, float]


def sampler_parameters(key: SamplerKey) -> tuple[tuple[int, int], tuple[int, int]]:
    """((min filter, mag filter), (wrap u, wrap v)) of a key. Raises ValueError for a bad word."""
    filter_name, wrap, *_ = key
    words = (wrap, wrap) if isinstance(wrap, str) else wrap
    if filter_name not in _FILTERS:
        raise ValueError(f"filter {filter_name!r} is none of {', '.join(_FILTERS)}")
    for word in words:
        if word not in _WRAPS:
            raise ValueError(f"wrap {word!r} is none of {', '.join(_WRAPS)}")
    return _FILTERS[filter_name], (_WRAPS[words[0]], _WRAPS[words[1]])
