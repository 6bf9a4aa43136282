/* Every function of shaders/ against its counterpart in cpu_reference/, bit for bit, and the time of both; in
 * the manner of dav1d's checkasm. */
#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/number.h"
#include "device.h"

static const char usage[] = "usage: functions [OPTION]...\n"
                            "  --seed N      of the random cases (default 1)\n"
                            "  --cases N     of each test (default 1048576)\n"
                            "  --first N     the number of the first case (default 0)\n"
                            "  --test NAME   only the test of this name\n"
                            "  --corrected   with the division and root for inexact devices\n"
                            "  --validate    with the Khronos validation layer\n";

enum { SHOWN_FAILURES = 3 }; /* of each test */

struct plan {
    unsigned long seed, cases, first;
    bool corrected;
    const char *only;
    struct vulkan_options vulkan;
};

struct result {
    unsigned long differing;
    double device_ns, reference_ns; /* of all cases */
};

/* Every test draws cases of its own: FNV-1a of its name. */
static uint64_t stream_of(const struct function_test *test)
{
    uint64_t stream = UINT64_C(0xcbf29ce484222325);
    for (const char *c = test->name; *c; ++c)
        stream = (stream ^ (unsigned char)*c) * UINT64_C(0x100000001b3);
    return stream;
}

/* Members of the input that the generator does not set are 0. */
static void generate(const struct plan *plan, const struct function_test *test, uint64_t number,
                     union word *input)
{
    struct random random = random_start(plan->seed, stream_of(test), number);
    random.promises = test->promises;
    memset(input, 0, test->input_words * sizeof *input);
    test->generate(&random, input);
}

/* `text` describes the words, see function_table.c. */
static void print_words(const char *title, const char *text, const union word *words)
{
    printf("  %s:\n", title);
    while (*text) {
        size_t length = strcspn(text, ": ");
        printf("    %.*s%s", (int)length, text, text[length] == ':' ? " =" : "");
        for (text += length; *text != ' '; ++text)
            if (*text == 'i')
                printf(" %" PRId32, (words++)->integer);
            else if (*text == 'f')
                printf(" %a", (double)(words++)->number);
        printf("\n");
        text += strspn(text, " ");
    }
}

static void print_failure(const struct plan *plan, const struct function_test *test, unsigned long number,
                          const union word *inputs, const union word *outputs, const union word *expected)
{
    printf("%s: case %lu differs (--test %s --seed %lu --first %lu --cases 1)\n", test->name, number,
           test->name, plan->seed, number);
    print_words("inputs", test->inputs, inputs);
    print_words("shader", test->outputs, outputs);
    print_words("C reference", test->outputs, expected);
}

/* The cases from `first` on, which are in the device's buffers. */
static void compare(const struct plan *plan, const struct function_test *test, unsigned long first,
                    size_t count, const struct device *device, const union word *expected,
                    struct result *result)
{
    for (size_t i = 0; i < count; ++i) {
        const union word *outputs = (const union word *)device->outputs.mapped + i * test->output_words;
        const union word *right = expected + i * test->output_words;
        if (memcmp(outputs, right, test->output_words * sizeof *outputs) == 0)
            continue;
        if (result->differing++ < SHOWN_FAILURES)
            print_failure(plan, test, first + i,
                          (const union word *)device->inputs.mapped + i * test->input_words, outputs, right);
    }
}

/* `expected` has room for a batch of outputs. */
static enum status run_batch(const struct plan *plan, const struct function_test *test, unsigned long first,
                             size_t count, struct device *device, union word *expected, struct result *result)
{
    union word *inputs = device->inputs.mapped;
    for (size_t i = 0; i < count; ++i)
        generate(plan, test, first + i, inputs + i * test->input_words);
    double device_ns, warming_ns;
    enum status status = STATUS_DONE;
    if (first == plan->first) /* drivers compile in the first dispatch */
        status = device_run(device, 1, &warming_ns);
    if (status == STATUS_DONE)
        status = device_run(device, count, &device_ns);
    if (status != STATUS_DONE)
        return status;
    result->device_ns += device_ns;

    double start = clock_ms();
    for (size_t i = 0; i < count; ++i)
        test->call(inputs + i * test->input_words, expected + i * test->output_words);
    result->reference_ns += (clock_ms() - start) * 1e6;
    compare(plan, test, first, count, device, expected, result);
    return STATUS_DONE;
}

static enum status run_test(const struct plan *plan, const struct function_test *test, struct device *device,
                            union word *expected)
{
    struct result result = {0};
    enum status status = device_load(device, test);
    for (unsigned long done = 0; status == STATUS_DONE && done < plan->cases; done += BATCH) {
        size_t count = plan->cases - done < BATCH ? plan->cases - done : BATCH;
        status = run_batch(plan, test, plan->first + done, count, device, expected, &result);
    }
    if (status != STATUS_DONE)
        return status;
    printf("%-34s %10lu %12.2f %12.2f\n", test->name, result.differing,
           result.device_ns / (double)plan->cases, result.reference_ns / (double)plan->cases);
    fflush(stdout);
    return result.differing > 0 ? STATUS_DIFFERS : STATUS_DONE;
}

static enum status run_tests(const struct plan *plan, struct vulkan_context *context)
{
    struct device device;
    union word *expected = malloc(sizeof *expected * BATCH * MOST_WORDS);
    if (!expected) {
        log_error("no memory for a batch");
        return STATUS_UNABLE;
    }
    enum status status = device_create(context, plan->corrected, &device), result = STATUS_DONE;
    if (status != STATUS_DONE) {
        free(expected);
        return status;
    }
    printf("%s%s, seed %lu, %lu cases each from %lu\n", context->properties.deviceName,
           device.corrected ? ", corrected" : "", plan->seed, plan->cases, plan->first);
    printf("%-34s %10s %12s %12s\n", "function", "differing", "device ns", "C ns");
    size_t matching = 0;
    for (size_t i = 0; i < function_test_count && result <= STATUS_DIFFERS; ++i) {
        if (plan->only && strcmp(plan->only, function_tests[i].name) != 0)
            continue;
        ++matching;
        status = run_test(plan, &function_tests[i], &device, expected);
        result = status != STATUS_DONE ? status : result;
    }
    if (matching == 0) {
        log_error("no test is called %s", plan->only);
        result = STATUS_REFUSED;
    }
    device_destroy(&device);
    free(expected);
    return result;
}

static bool read_plan(int argc, char **argv, struct plan *plan)
{
    enum { SEED = 1, CASES, FIRST, TEST, CORRECTED, VALIDATE };
    static const struct option options[] = {{"seed", required_argument, NULL, SEED},
                                            {"cases", required_argument, NULL, CASES},
                                            {"first", required_argument, NULL, FIRST},
                                            {"test", required_argument, NULL, TEST},
                                            {"corrected", no_argument, NULL, CORRECTED},
                                            {"validate", no_argument, NULL, VALIDATE},
                                            {0}};
    int option;
    bool valid = true;
    while (valid && (option = getopt_long(argc, argv, "", options, NULL)) != -1) {
        size_t length = optarg ? strlen(optarg) : 0;
        if (option == SEED || option == CASES || option == FIRST) {
            unsigned long *number = option == SEED    ? &plan->seed
                                    : option == CASES ? &plan->cases
                                                      : &plan->first;
            valid = parse_unsigned(optarg, length, UINT32_MAX, number);
        } else if (option == TEST) {
            plan->only = optarg;
        } else if (option == CORRECTED) {
            plan->corrected = true;
        } else if (option == VALIDATE) {
            plan->vulkan.validate = true;
        } else {
            valid = false;
        }
    }
    return valid && optind == argc && plan->cases > 0;
}

int main(int argc, char **argv)
{
    struct plan plan = {.seed = 1, .cases = 1 << 20};
    if (!read_plan(argc, argv, &plan)) {
        fputs(usage, stderr);
        return STATUS_REFUSED;
    }
    struct vulkan_context *context;
    enum status status = vulkan_context_create(&plan.vulkan, &context);
    if (status != STATUS_DONE)
        return (int)status;
    status = run_tests(&plan, context);
    enum status closed = vulkan_context_destroy(&context);
    return (int)(status != STATUS_DONE ? status : closed);
}
