// The film curve: a line over log10 of radiance with a toe and a shoulder, each half a tanh.
#include "shared/film.glsl"

const float LOG10_2 = 0.30102999566;

// tanh for all x; the built-in overflows on some drivers.
vec3 tanh_safe(vec3 x) { return 1.0 - 2.0 / (exp(2.0 * clamp(x, -20.0, 20.0)) + 1.0); }

// Departures of toe and shoulder from the line are added; both are C1 and the sum rises
// everywhere [docs/post.md "Film curve"].
vec3 film_curve(vec3 radiance) {
    vec3 decades = LOG10_2 * log2(max(radiance, vec3(1e-10)));
    float slope = u_film.slope;
    vec3 into_toe = min(slope * (decades - u_film.toe_start), vec3(0.0));
    vec3 into_shoulder = max(slope * (decades - u_film.shoulder_start), vec3(0.0));
    vec3 toe = u_film.toe_scale * tanh_safe(into_toe / u_film.toe_scale) - into_toe;
    vec3 bend = into_shoulder / u_film.shoulder_scale;
    vec3 shoulder = u_film.shoulder_scale * tanh_safe(bend) - into_shoulder;
    return clamp(u_film.line_height + slope * decades + toe + shoulder, 0.0, 1.0);
}

// cos^4 of the angle to the axis: the natural falloff of a lens. `place`: from the centre, the
// corner at distance 1.
float vignette(vec2 place) {
    float cos2 = 1.0 / (1.0 + u_film.vignette * u_film.vignette * dot(place, place));
    return cos2 * cos2;
}
