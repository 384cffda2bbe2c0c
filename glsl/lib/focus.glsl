// Circles of confusion. [Potmesil81 "A Lens and Aperture Camera Model"] has the physics; here the
// circle grows linearly over the artist's transitions [docs/post.md "Depth of field"].
#include "shared/focus.glsl"

const float SHARP_PX = 0.5;  // smaller circles stay inside their pixel

// Radius in px of the picture; negative before the focus. depth_m: along the view.
float circle_radius(float depth_m) {
    float behind = depth_m - u_focus.distance;
    float share = clamp(behind < 0.0 ? behind * u_focus.per_near : behind * u_focus.per_far, -1.0,
                        1.0);
    return share * u_focus.largest_px;
}
