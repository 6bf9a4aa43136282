#include "tracer/interface.h"

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
#include "whitted_exact_plain.h"
#include "whitted_exact_storage.h"
#include "whitted_fast.h"
#include "whitted_fast_storage.h"

struct spirv whitted_spirv(struct shader_choice choice, bool plain)
{
#define CODE(name) name, sizeof name
    if (plain && choice.variant == WHITTED_EXACT && !choice.scene_in_storage)
        return (struct spirv){CODE(whitted_exact_plain)};
    static const struct spirv variants[][2] = {
        [WHITTED_EXACT] = {{CODE(whitted_exact)}, {CODE(whitted_exact_storage)}},
        [WHITTED_CORRECTED] = {{CODE(whitted_corrected)}, {CODE(whitted_corrected_storage)}},
        [WHITTED_DOUBLE] = {{CODE(whitted_double)}, {CODE(whitted_double_storage)}},
        [WHITTED_FAST] = {{CODE(whitted_fast)}, {CODE(whitted_fast_storage)}},
        [WHITTED_EXACT_EVENTS] = {{CODE(whitted_exact_events)}, {CODE(whitted_exact_events_storage)}},
        [WHITTED_CORRECTED_EVENTS] = {{CODE(whitted_corrected_events)},
                                      {CODE(whitted_corrected_events_storage)}},
        [WHITTED_DOUBLE_EVENTS] = {{CODE(whitted_double_events)}, {CODE(whitted_double_events_storage)}},
    };
#undef CODE
    return variants[choice.variant][choice.scene_in_storage];
}
