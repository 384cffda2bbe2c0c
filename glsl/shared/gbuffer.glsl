// What the G-buffer's numbers mean. [Mittring12 "GBuffer" table]

// Lighting model, the 2 bits of A's alpha.
const uint LIGHTING_UNLIT = 0u;       // scene_color is final
const uint LIGHTING_DEFAULT = 1u;
const uint LIGHTING_SUBSURFACE = 2u;  // default plus light through the surface
const uint LIGHTING_CLOTH = 3u;       // a fuzz of fibres instead of a smooth lobe

// The depth of a pixel that nothing covers.
const float DEPTH_CLEAR = 1.0;
