"""The machine room: device, shaders, resources and the frame graph. See docs/frame-graph.md."""
