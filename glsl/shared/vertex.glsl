// The scene's vertices as floats, for the passes that move them.

const uint DEFORM_GROUP = 64u;      // vertices, threads a group
const uint POSITION_FLOATS = 3u;    // a vertex in the scene's positions
const uint SURFACE_FLOATS = 12u;    // in the scene's surface: normal, tangent, uv0, uv1, colour
