const float PI = 3.14159265358979;
const float INVERSE_PI = 1.0 / PI;
