// DrawElementsIndirectCommand (OpenGL 4.3 core, section 10.3.10).
struct DrawCommand {
    uint count;
    uint instance_count;
    uint first_index;
    uint base_vertex;
    uint base_instance;
};
