// What a shader's LIGHT_CELLS can be: it goes over all lights, or those of the cells of a grid that
// divides the view by tiles and depth [Olsson12 "Clustered Deferred and Forward Shading"], or a
// cube of the world evenly.
#define ALL_LIGHTS 0
#define VIEW_CELLS 1
#define WORLD_CELLS 2
