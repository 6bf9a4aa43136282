#include "image/viridis.h"

#include <math.h>

void viridis(double level, uint8_t *rgb)
{
    static const double ramp[5][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    level = fmin(fmax(level, 0.0), 1.0);
    int quarter = level < 1.0 ? (int)(level * 4.0) : 3;
    double fraction = level * 4.0 - quarter;
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)lround(ramp[quarter][c] + fraction * (ramp[quarter + 1][c] - ramp[quarter][c]));
}
