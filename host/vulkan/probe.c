#include "vulkan/probe.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "arithmetic_probe.h"
#include "base/clock.h"
#include "vulkan/pass.h"

enum { PROBES = 1 << 14, GROUP = 64 };
static const uint64_t seed = 1980;

/* In the order of probe.comp. */
struct results {
    float quotient, root, sum, difference, product, product_sum, product_difference, dot;
};

static bool same(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* Zero, or normal and not so small that it may have been rounded up from a denormal. */
static bool counts(float x)
{
    return x == 0 || (fabsf(x) > FLT_MIN && fabsf(x) <= FLT_MAX);
}

/* Notes the first flaw. */
static void judge_basics(const struct operands *on, const struct results *results, struct arithmetic *found)
{
    const float a = on->a, b = on->b, c = on->c, ab = a * b, bc = b * c, ca = c * a;
    const struct {
        const char *operation;
        float result, expected;
        bool counts;
    } basics[] = {
        {"a + b", results->sum, a + b, true},
        {"a - b", results->difference, a - b, true},
        {"a * b", results->product, ab, true},
        {"a * b + c", results->product_sum, ab + c, counts(ab)},
        {"c - a * b", results->product_difference, c - ab, counts(ab)},
        {"a * b + b * c + c * a", results->dot, ab + bc + ca,
         counts(ab) && counts(bc) && counts(ca) && counts(ab + bc)},
    };
    for (size_t i = 0; i < sizeof basics / sizeof *basics && found->basics_exact; ++i) {
        const float result = basics[i].result, expected = basics[i].expected;
        if (!basics[i].counts || !counts(expected) || same(result, expected))
            continue;
        found->basics_exact = false;
        snprintf(found->flaw, sizeof found->flaw, "%s with a = %a, b = %a, c = %a is %a instead of %a",
                 basics[i].operation, (double)a, (double)b, (double)c, (double)result, (double)expected);
    }
}

static void judge(const struct operands *operands, const struct results *results, struct arithmetic *found)
{
    *found =
        (struct arithmetic){.known = true, .basics_exact = true, .division_exact = true, .root_exact = true};
    for (size_t i = 0; i < PROBES; ++i) {
        const float a = operands[i].a, b = operands[i].b, c = operands[i].c;
        if (!counts(a) || !counts(b) || !counts(c))
            continue;
        if (counts(a / b) && !same(results[i].quotient, a / b))
            found->division_exact = false;
        if (!same(results[i].root, sqrtf(fabsf(a))))
            found->root_exact = false;
        judge_basics(&operands[i], &results[i], found);
    }
}

enum status probe_arithmetic(struct vulkan_context *context)
{
    if (context->arithmetic.known)
        return STATUS_DONE;
    static struct operands operands[PROBES];
    static struct results results[PROBES];
    double start = clock_ms();
    hostile_operands(seed, operands, PROBES);
    enum status status = vulkan_compute(
        context, &(struct compute_job){
                     .pass = {.name = "probe", .code = {arithmetic_probe, sizeof arithmetic_probe}},
                     .input = operands,
                     .input_size = sizeof operands,
                     .output = results,
                     .output_size = sizeof results,
                     .groups = PROBES / GROUP,
                 });
    if (status == STATUS_DONE) {
        judge(operands, results, &context->arithmetic);
        log_info("arithmetic probed in %.1f ms", clock_ms() - start);
    }
    return status;
}

enum status probe_require_exact(struct vulkan_context *context)
{
    enum status status = probe_arithmetic(context);
    if (status != STATUS_DONE || context->arithmetic.basics_exact)
        return status;
    log_error("%s cannot compute exactly: %s; --fast renders without a promise",
              context->properties.deviceName, context->arithmetic.flaw);
    return STATUS_UNABLE;
}

enum status probe_print(struct vulkan_context *context)
{
    enum status status = probe_arithmetic(context);
    if (status != STATUS_DONE)
        return status;
    const struct arithmetic *found = &context->arithmetic;
    printf("      arithmetic      ÷ %s, √ %s, %s: %s\n", found->division_exact ? "exact" : "inexact",
           found->root_exact ? "exact" : "inexact", found->basics_exact ? "no contraction" : found->flaw,
           !found->basics_exact      ? "only --fast"
           : needs_correction(found) ? "corrected"
                                     : "native");
    return STATUS_DONE;
}
