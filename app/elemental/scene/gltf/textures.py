"""Textures: images decoded on worker threads while the geometry is read."""

from __future__ import annotations

import math
import os
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Literal
from urllib.parse import unquote

import numpy as np

from elemental.core.errors import InputError
from elemental.core.images import check_side, read_png_jpeg_webp
from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field, printable
from elemental.scene.model import ByteArray, FloatArray, Texture, TextureSlot, Wrap

WRAPS: dict[int, Wrap] = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
NEAREST = 9728
FILTERS = {9728: "nearest", 9729: "linear"}
KTX2_MAGIC = b"\xabKTX 20\xbb\r\n\x1a\n"
WEBP_EXTENSION = "EXT_texture_webp"
KTX2_EXTENSION = "KHR_texture_basisu"
TRANSFORM_EXTENSION = "KHR_texture_transform"
MAX_WORKERS = 8

Sampler = tuple[Wrap, Wrap, bool]


class Textures:
    """The textures that a document's materials use; a context manager around its worker threads."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._images = document.root.elements("images")
        self._samplers = document.root.elements("samplers")
        self._fields = document.root.elements("textures")
        self._workers = ThreadPoolExecutor(min(MAX_WORKERS, os.cpu_count() or 1))
        self._pixels: dict[int, Future[ByteArray] | None] = {}
        self._used: dict[tuple[int, Sampler], int] = {}

    def __enter__(self) -> Textures:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self._workers.shutdown(wait=True, cancel_futures=True)

    def slot(self, owner: Field, key: str) -> TextureSlot | None:
        """The textureInfo `key` of a material; None if absent or, with a warning, unreadable."""
        info = owner.find(key)
        if info is None:
            return None
        texture = self._fields[info.need("index").index(len(self._fields), "textures")]
        transform = info.extension(TRANSFORM_EXTENSION)
        uv_set = info.integer_or("texCoord", 0)
        uv_set = transform.integer_or("texCoord", uv_set) if transform else uv_set
        if uv_set not in (0, 1):
            info.warn(f"TEXCOORD_{uv_set} is not supported; the texture is left out")
            return None
        image = self._image_of(texture)
        if image is None:
            return None
        used = self._used.setdefault((image, self._sampler_of(texture)), len(self._used))
        chosen: Literal[0, 1] = 1 if uv_set else 0
        return TextureSlot(used, chosen, _uv_matrix(transform))

    def finish(self) -> list[Texture]:
        """Wait for the decoders. Raises InputError for an image that can't be decoded."""
        textures = []
        for image, (wrap_u, wrap_v, nearest) in self._used:
            pixels = self._pixels[image]
            assert pixels is not None
            name = self._image_name(image)
            textures.append(Texture(name, pixels.result(), wrap_u, wrap_v, nearest))
        return textures

    def _image_of(self, texture: Field) -> int | None:
        """The image of a texture that can be read, its decoding begun."""
        webp, ktx2 = texture.extension(WEBP_EXTENSION), texture.extension(KTX2_EXTENSION)
        owners = [owner for owner in (webp, texture, ktx2) if owner and owner.find("source")]
        if not owners:
            texture.warn("has no image that can be read; the material's factor is used alone")
            return None
        for owner in owners:
            image = owner.need("source").index(len(self._images), "images")
            if image not in self._pixels:
                self._pixels[image] = self._decode(image)
            if self._pixels[image] is not None:
                return image
        return None

    def _decode(self, image: int) -> Future[ByteArray] | None:
        """Begin to decode an image; None, with a warning, for KTX2."""
        field, name = self._images[image], self._image_name(image)
        uri = field.find("uri")
        if uri is not None:
            encoded = self._document.resolve(uri)
        else:
            view = field.need("bufferView").index(len(self._document.views), "bufferViews")
            encoded = bytes(self._document.view(view)[0])
        if encoded.startswith(KTX2_MAGIC):
            field.warn(f"{name}: KTX2 is not supported; the material's factor is used alone")
            return None
        return self._workers.submit(self._decode_now, field, encoded, name)

    def _decode_now(self, field: Field, encoded: bytes, name: str) -> ByteArray:
        try:
            pixels = read_png_jpeg_webp(encoded, name)
            check_side(name, pixels.shape)
            return pixels
        except InputError as error:
            raise field.error(str(error)) from error

    def _image_name(self, image: int) -> str:
        field = self._images[image]
        uri = field.text_or("uri", "data:")
        if uri.startswith("data:"):
            return field.text_or("name", f"image{image}")
        return printable(unquote(uri))

    def _sampler_of(self, texture: Field) -> Sampler:
        index = texture.index_or_none("sampler", len(self._samplers), "samplers")
        if index is None:
            return "repeat", "repeat", False
        sampler = self._samplers[index]
        wrap_u = sampler.choice_or("wrapS", WRAPS[10497], WRAPS)
        wrap_v = sampler.choice_or("wrapT", WRAPS[10497], WRAPS)
        return wrap_u, wrap_v, sampler.choice_or("magFilter", "linear", FILTERS) == "nearest"


def _uv_matrix(transform: Field | None) -> FloatArray:
    """(2, 3) offset @ rotation @ scale of KHR_texture_transform.

    The rotation is counter-clockwise as seen with v downwards: so the extension's words and its
    example have it, and so viewers do; its GLSL snippet alone turns the other way.
    """
    if transform is None:
        return np.eye(2, 3, dtype=np.float32)
    offset, scale = transform.find("offset"), transform.find("scale")
    angle = transform.number_or("rotation", 0.0)
    sine, cosine = math.sin(angle), math.cos(angle)
    matrix = np.zeros((2, 3), np.float32)
    matrix[:, :2] = [[cosine, sine], [-sine, cosine]]
    matrix[:, :2] *= scale.numbers(2) if scale else 1.0
    matrix[:, 2] = offset.numbers(2) if offset else 0.0
    return matrix
