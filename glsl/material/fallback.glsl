// Stands for a material that does not compile: loud, in every pass alike.
void material(inout Surface s, MaterialInput m, Parameters p) {
    s = fallback_surface(m.position_ws);
}

vec3 displace(MaterialInput m, Parameters p) { return vec3(0.0); }
