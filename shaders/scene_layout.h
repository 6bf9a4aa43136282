/* The packed scene: what the device reads. Included by GLSL and by C, so that neither side can drift.
 * std140 and std430 agree with C here, because every member is a vector of four.
 *
 * Lengths are in scene units: metres times a power of two that brings the scene's extent into (1/2, 1],
 * so that no square under- or overflows and a scene scaled by a power of two packs to the same bits. */
#ifndef SCENE_LAYOUT_H
#define SCENE_LAYOUT_H

#ifdef VULKAN /* defined by glslang */
#define LAYOUT_VEC4 vec4
#define LAYOUT_IVEC4 ivec4
#else
typedef struct {
    float x, y, z, w;
} layout_vec4;
typedef struct {
    int x, y, z, w;
} layout_ivec4;
typedef struct PackedSurface PackedSurface;
#define LAYOUT_VEC4 layout_vec4
#define LAYOUT_IVEC4 layout_ivec4
#endif

#define KIND_MATTE 0
#define KIND_MIRROR 1
#define KIND_TRANSPARENT 2

/* Nothing is met farther away than this, in scene units: its square and the square of any distance
 * between two such points stay finite. */
#define FARTHEST_HIT 1125899906842624.0 /* 2^50 */

/* A light nearer than 2^-30 scene units does not shine: float cannot tell where it is. */
#define NEAREST_LIGHT_SQUARED 8.673617379884035e-19 /* 2^-60 */

/* A direction's component along a normal below this is parallel. Far below what float arithmetic on
 * unit vectors yields otherwise; it keeps decisions away from denormals, which drivers treat differently. */
#define PARALLEL 7.888609052210118e-31 /* 2^-100 */

/* A ray of smaller weight is not traced and a smaller pixel value is 0, for the same reason. */
#define SMALLEST_WEIGHT 8.077935669463161e-28 /* 2^-90 */

/* What the device has of the spheres that are not looped over, in records of four words; see hierarchy.glsl.
 */
#define GRID_ORIGIN 0 /* records at the beginning: a point of the grid, and the boxes' largest coordinate */
#define GRID_STEP 1
#define STREAM 2        /* where the stream begins and ends */
#define HEAD_RECORDS 3u /* the first pair's place */
#define BOX_FLAG                                                                                             \
    0xc0000000u /* with a record's number the last word of a box; that of a sphere is its radius */

/* A word for each record, undefined where that is no sphere: its number, and flags; behind them some for each
 * sphere. */
#define HOLDS_RAYS_FLAG 0x80000000u
#define HOLDS_LIGHTS_FLAG 0x40000000u
#define PLACE_IN_PAIRS 0
#define PLACE_IN_STREAM 1
#define SPHERE_SURFACE 2 /* index into the scene's surfaces */
#define SPHERE_WORDS 3

/* The slots of vectors and of words in which an invocation keeps its work between dispatches; behind them is
 * its stack. */
#define WORK_REALS 5
#define WORK_WORDS 11

/* A stack for more bounces than these does not lie in registers alone, see path.glsl. */
#define MOST_IN_REGISTERS 8

/* What the direction of a ray, and its line projected along the normal of the parallel mirrors that reflect
 * it, may be off by after 1000 bounces, relative: a bounce loses less than 2^-20. */
#define MIRROR_DRIFT 0.0009765625 /* 2^-10 */

/* The charge for a ray that is not traced is its weight, which is its share in the pixel: times the bound on
 * radiance the most that it could have brought. Charges are summed to nearest; this factor after each
 * addition makes the sum one that is rounded up. */
#define ROUND_UP 1.0000002384185791015625   /* 1 + 2^-22 */
#define ROUND_DOWN 0.9999997615814208984375 /* 1 - 2^-22: likewise what is left of an allowance */
#define LEAST_ROOM 9.5367431640625e-7       /* 2^-20: a smaller share of an allowance is not used */

/* What both tracers can tell of one pixel: events in the order of the recursion. Each has a head and values:
 * two vectors and a number. */
#define EVENT_RAY 0      /* values: origin, direction, weight */
#define EVENT_HIT 1      /* values: normal, point, distance */
#define EVENT_SPLIT 2    /* at glass; values: refracted direction, (cos_in, k_r) */
#define EVENT_UNTRACED 3 /* values: (weight, charge of the sample so far) */
#define EVENT_LIGHT 4    /* a point of a light; values: point, (distance, cos_in, received), area */
#define EVENT_LEAF 5     /* values: radiance seen, contribution */
#define EVENT_SAMPLE 6   /* values: radiance, 0, charge */
#define EVENT_PIXEL 7    /* values: radiance */
#define EVENT_KINDS 8
#define EVENT_VALUES 8 /* 3, 3, 1, and one to fill up */

#define UNTRACED_REFLECTED 0
#define UNTRACED_REFRACTED 1
#define UNTRACED_BOUNCES 2 /* max_bounces */
#define UNTRACED_ESCAPES 3 /* see escape.glsl */

#define LIGHT_TOO_NEAR 0 /* to shine, see NEAREST_LIGHT_SQUARED */
#define LIGHT_BEHIND 1   /* the surface */
#define LIGHT_SHADOW_RAY 2

/* What the slots of an event's head hold. */
#define EVENT_KIND x      /* place: EVENT_RAY, ... */
#define EVENT_OF_SAMPLE y /* the pixel's sample */
#define EVENT_BRANCH                                                                                         \
    z                   /* of the ray, in the tree of its sample: 0 the primary ray, children of i: 2 i + 1  \
                         * refracted, 2 i + 2 reflected */
#define EVENT_BOUNCES w /* of the ray */
#define EVENT_SURFACE x /* facts: the surface that a ray leaves or meets; -1: none */
#define EVENT_INWARD y  /* of rays: into the body whose surface they leave */
#define EVENT_FROM_INSIDE y /* of hits */
#define EVENT_TOTAL x       /* of splits: total reflection */
#define EVENT_REASON x      /* of rays that are not traced: UNTRACED_ */
#define EVENT_OF_LIGHT x    /* of points of lights: the light; point lights come first */
#define EVENT_LIGHT_SAMPLE y
#define EVENT_LIGHT_STATE z /* LIGHT_ */
#define EVENT_BLOCKER w     /* the surface that stands in between; -1: none */

struct EventHead {
    LAYOUT_IVEC4 place; /* which step of the ray tree it is */
    LAYOUT_IVEC4 facts; /* its decisions */
};

/* What the slots of vectors hold: sphere.tags.FILE_ORDER, and so on. */
#define OREN_NAYAR_A w   /* PackedSurface.parameters of matte; albedo / pi is in xyz */
#define ETA_ENTERING x   /* of glass: eta = n1 / n2 for a ray that enters the body */
#define KAPPA_ENTERING y /* 1 - eta^2 */
#define ETA_EXITING z    /* for one that exits it */
#define KAPPA_EXITING w
#define OREN_NAYAR_B x /* PackedSurface.more_parameters of matte */
#define CURVATURE y    /* PackedSurface.more_parameters of giants: 1 / radius */
#define SURFACE_KIND x /* PackedSurface.tags: KIND_ */
#define FILE_ORDER                                                                                           \
    y /* of spheres and of planes' surfaces: place in the scene file, where each row of a file of            \
       * spheres counts; the first of equally near surfaces is hit */
#define CASTS_SHADOWS z /* of planes: 0 where a plane cannot stand between a light and what is seen */
#define OTHERS_BEFORE                                                                                        \
    w /* of planes' surfaces and of those of spheres that are looped over: how many other spheres come       \
         before */
#define SURFACE x      /* of spheres: index into the scene's surfaces */
#define HOLDS_RAYS z   /* of spheres: a ray or a shading point may lie inside, other than on the surface */
#define HOLDS_LIGHTS w /* of spheres: so may a point of a light */
#define SHARED_A x     /* PackedView.matte: Oren-Nayar's A and B, where all matte surfaces share them */
#define SHARED_B y
#define RADIANCE_BOUND x /* PackedView.truncation: no ray brings more radiance than this */
#define UNBOUNDED                                                                                            \
    1267650600228229401496703205376.0 /* 2^100 as RADIANCE_BOUND: a light touches a matte surface */
#define ALLOWANCE y /* what a sample may be charged for rays left out; negative: none is left out */
#define SPENDING z  /* how readily that is spent, see NUMERICS.md */

struct PackedSurface {
    LAYOUT_VEC4 parameters;
    LAYOUT_VEC4 more_parameters;
    LAYOUT_IVEC4 tags;
};

/* A giant, which has a surface of its own, has instead the height of a point x over its surface,
 * gradient . x + curvature / 2 |x|^2 - offset: the gradient in xyz, the offset in w. With centre c and radius
 * r that is (|x - c|^2 - r^2) / (2 r), the distance from the surface for points near it. */
struct PackedSphere {
    LAYOUT_VEC4 center_radius;
    LAYOUT_IVEC4 tags;
};

/* What the device has of one that is looped over. */
struct LoopedSphere {
#ifdef VULKAN
    PackedSphere sphere;
#else
    struct PackedSphere sphere;
#endif
    PackedSurface surface;
};

/* The points p with normal . p = offset. An opaque plane's normal points to the camera's side, where all
 * rays and points stay; a transparent plane's points out of the glass. */
struct PackedPlane {
    LAYOUT_VEC4 normal_offset; /* unit normal */
    PackedSurface surface;
};

struct PackedPointLight {
    LAYOUT_VEC4 position;
    LAYOUT_VEC4 intensity; /* color power, in radiance times square scene units */
};

/* One sample's share: the estimate is the plain sum over the samples. */
struct PackedQuadLight {
    LAYOUT_VEC4 corner;
    LAYOUT_VEC4 edge_u;
    LAYOUT_VEC4 edge_v;
    LAYOUT_VEC4 area_normal; /* u x v */
    LAYOUT_VEC4 radiance;    /* color power / samples */
};

struct PackedView {
    LAYOUT_VEC4 position;
    LAYOUT_VEC4 forward;          /* to the middle of the image plane at distance 1 */
    LAYOUT_VEC4 half_pixel_right; /* on that plane */
    LAYOUT_VEC4 half_pixel_down;
    LAYOUT_VEC4 background; /* radiance */
    LAYOUT_VEC4 matte;
    LAYOUT_VEC4 truncation;
    LAYOUT_VEC4 between_mirrors; /* xyz: unit normal of parallel mirrors, w: not 0 where rays that escape
                                  * between them are to be left out */
};

#endif
