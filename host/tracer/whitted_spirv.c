#include "tracer/whitted_spirv.h"

#include "whitted_corrected.h"
#include "whitted_corrected_events.h"
#include "whitted_corrected_events_storage.h"
#include "whitted_corrected_storage.h"
#include "whitted_double.h"
#include "whitted_double_events.h"
#include "whitted_double_events_storage.h"
#include "whitted_double_storage.h"
#include "whitted_exact.h"
#include "whitted_exact_events.h"
#include "whitted_exact_events_storage.h"
#include "whitted_exact_storage.h"
#include "whitted_fast.h"
#include "whitted_fast_storage.h"

struct spirv whitted_spirv(enum whitted_variant variant, bool scene_in_storage)
{
#define VARIANT(name)                                                                                        \
    {                                                                                                        \
        {name, sizeof name},                                                                                 \
        {                                                                                                    \
            name##_storage, sizeof name##_storage                                                            \
        }                                                                                                    \
    }
    static const struct spirv variants[][2] = {
        [WHITTED_EXACT] = VARIANT(whitted_exact),
        [WHITTED_CORRECTED] = VARIANT(whitted_corrected),
        [WHITTED_DOUBLE] = VARIANT(whitted_double),
        [WHITTED_FAST] = VARIANT(whitted_fast),
        [WHITTED_EXACT_EVENTS] = VARIANT(whitted_exact_events),
        [WHITTED_CORRECTED_EVENTS] = VARIANT(whitted_corrected_events),
        [WHITTED_DOUBLE_EVENTS] = VARIANT(whitted_double_events),
    };
#undef VARIANT
    return variants[variant][scene_in_storage];
}

const char *const *whitted_defines(enum whitted_variant variant, bool scene_in_storage)
{
    static const char *const variants[][2][3] = {
        [WHITTED_EXACT] = {{NULL}, {"-DSCENE_IN_STORAGE"}},
        [WHITTED_CORRECTED] = {{"-DCORRECTED"}, {"-DCORRECTED", "-DSCENE_IN_STORAGE"}},
        [WHITTED_DOUBLE] = {{"-DDOUBLE"}, {"-DDOUBLE", "-DSCENE_IN_STORAGE"}},
        [WHITTED_FAST] = {{"-DFAST"}, {"-DFAST", "-DSCENE_IN_STORAGE"}},
    };
    return variants[variant][scene_in_storage];
}
