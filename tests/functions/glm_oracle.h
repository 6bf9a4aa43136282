/* GLM's reflect and refract in double, for C. */
#ifndef GLM_ORACLE_H
#define GLM_ORACLE_H

#ifdef __cplusplus
extern "C" {
#endif

struct oracle_vector {
    double x, y, z;
};

struct oracle_vector oracle_reflect(struct oracle_vector direction, struct oracle_vector normal);

/* 0 for total reflection. */
struct oracle_vector oracle_refract(struct oracle_vector direction, struct oracle_vector normal, double eta);

#ifdef __cplusplus
}
#endif

#endif
