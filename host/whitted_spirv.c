#include "whitted_spirv.h"

#include "whitted_exact.h"
#include "whitted_exact_storage.h"
#include "whitted_fast.h"
#include "whitted_fast_storage.h"

struct spirv whitted_spirv(bool fast, bool scene_in_storage)
{
    static const struct spirv variants[2][2] = {
        {{whitted_exact, sizeof whitted_exact}, {whitted_exact_storage, sizeof whitted_exact_storage}},
        {{whitted_fast, sizeof whitted_fast}, {whitted_fast_storage, sizeof whitted_fast_storage}},
    };
    return variants[fast][scene_in_storage];
}
