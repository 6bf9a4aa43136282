#ifndef VKWHITTED_ORACLE_ORACLE_H
#define VKWHITTED_ORACLE_ORACLE_H

#include <vector>

#include "ball.h"

extern "C" {
#include "packed_scene.h"
}

/* A Whitted tracer in ball arithmetic: encloses the exact radiance that a packed scene sends through a pixel.
 * Written from the README's model and the layout of the packed scene alone. Nothing of it is cpu_reference's
 * or the shader's, but for the numbers that choose the points of a quad light (shaders/sampling.glsl). */

struct OracleBody {
    bool is_sphere;
    Vector vector;    /* a sphere's centre, a giant's gradient, a plane's normal */
    Ball number;      /* its radius, its offset */
    double curvature; /* of a giant, otherwise 0 */
    const PackedSurface *surface;
    int order; /* in the scene file */
    bool casts_shadows;
};

struct OraclePixel {
    Vector radiance;
    long bits;     /* the precision that it took */
    int ties;      /* surfaces at exactly the same distance, of which the first in the scene file is hit */
    int undecided; /* decisions that the last precision cannot tell from such; what is touched is missed */
};

class Oracle
{
  public:
    explicit Oracle(const packed_scene &scene);

    /* Through the centre of the pixel in column x and row y. */
    OraclePixel trace(int x, int y) const;

  private:
    const packed_scene &scene;
    std::vector<OracleBody> bodies; /* in the order of the scene file */
};

#endif
