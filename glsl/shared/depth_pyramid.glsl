// One reduction of the depth pyramid.
layout(std140) uniform DepthPyramid {
    ivec2 source_size;  // texels that hold depths
} u_pyramid;
