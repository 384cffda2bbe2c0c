// A column-major matrix from four texels of a buffer. Its bits come as integers: what copies floats
// may flush small ones, and the words beside them are no floats.
mat4 texel_matrix(usamplerBuffer texels, uint first) {
    int at = int(first);
    return mat4(uintBitsToFloat(texelFetch(texels, at)),
                uintBitsToFloat(texelFetch(texels, at + 1)),
                uintBitsToFloat(texelFetch(texels, at + 2)),
                uintBitsToFloat(texelFetch(texels, at + 3)));
}
