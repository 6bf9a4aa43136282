#include "glm_oracle.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

static glm::dvec3 vector(oracle_vector v)
{
    return {v.x, v.y, v.z};
}

oracle_vector oracle_reflect(oracle_vector direction, oracle_vector normal)
{
    glm::dvec3 reflected = glm::reflect(vector(direction), vector(normal));
    return {reflected.x, reflected.y, reflected.z};
}

oracle_vector oracle_refract(oracle_vector direction, oracle_vector normal, double eta)
{
    glm::dvec3 refracted = glm::refract(vector(direction), vector(normal), eta);
    return {refracted.x, refracted.y, refracted.z};
}
