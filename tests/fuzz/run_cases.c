/* Runs a fuzz target without libFuzzer: TARGET CASES SEED CORPUS [DICTIONARY]
 *
 * CORPUS is a folder of files, each of which is run as it is; then as many cases are made of them by random
 * mutations. A case depends on the seed, its number and the corpus alone. Where the target crashes, aborts or
 * takes longer than a case may, the input is left in crash.SEED.CASE in the working folder. */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fuzz.h"

enum {
    MOST_INPUTS = 256,
    MOST_BYTES = 1 << 16, /* of a case */
    MOST_WORDS = 256,
    CASE_SECONDS = 20, /* with sanitizers, on a busy machine */
};

struct bytes {
    uint8_t *data;
    size_t size;
};

static struct bytes inputs[MOST_INPUTS], words[MOST_WORDS];
static size_t input_count, word_count;
static struct bytes current;
static char crash_name[64];

/* splitmix64. */
static uint64_t random_state;
static uint64_t next_random(void)
{
    uint64_t z = random_state += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

static size_t below(size_t limit)
{
    return limit > 0 ? (size_t)(next_random() % limit) : 0;
}

static void keep_crash(int number)
{
    int file = open(crash_name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0 && write(file, current.data, current.size) >= 0)
        close(file);
    signal(number, SIG_DFL);
    raise(number);
}

static void run(unsigned long seed, size_t number)
{
    uint8_t *exact = malloc(current.size + (current.size == 0)); /* so that sanitizers see reads behind it */
    if (!exact)
        abort();
    memcpy(exact, current.data, current.size);
    snprintf(crash_name, sizeof crash_name, "crash.%lu.%zu", seed, number);
    alarm(CASE_SECONDS);
    LLVMFuzzerTestOneInput(exact, current.size);
    free(exact);
}

static struct bytes read_bytes(const char *path)
{
    struct bytes bytes = {malloc(MOST_BYTES), 0};
    FILE *file = fopen(path, "rb");
    if (!file || !bytes.data) {
        perror(path);
        exit(2);
    }
    bytes.size = fread(bytes.data, 1, MOST_BYTES, file);
    fclose(file);
    return bytes;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void read_corpus(const char *folder)
{
    char *names[MOST_INPUTS];
    size_t count = 0;
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries)) && count < MOST_INPUTS;)
        if (entry->d_name[0] != '.' && asprintf(&names[count], "%s/%s", folder, entry->d_name) > 0)
            ++count;
    if (count == 0) {
        fprintf(stderr, "%s: no files\n", folder);
        exit(2);
    }
    closedir(entries);
    qsort(names, count, sizeof *names, by_name);
    for (size_t i = 0; i < count; ++i) {
        struct stat about;
        if (stat(names[i], &about) == 0 && S_ISREG(about.st_mode))
            inputs[input_count++] = read_bytes(names[i]);
        free(names[i]);
    }
}

/* Takes the words from libFuzzer's form: "word" on a line, with \xHH in it. */
static void read_dictionary(const char *path)
{
    char line[256];
    FILE *file = fopen(path, "r");
    while (file && word_count < MOST_WORDS && fgets(line, sizeof line, file)) {
        char *from = strchr(line, '"'), *end = strrchr(line, '"');
        if (line[0] == '#' || !from || end == from)
            continue;
        struct bytes *word = &words[word_count++];
        word->data = malloc(sizeof line);
        unsigned value;
        for (++from; word->data && from < end; ++word->size) {
            bool escaped = from[0] == '\\', hex = escaped && sscanf(from, "\\x%2x", &value) == 1;
            word->data[word->size] = (uint8_t)(hex ? value : (unsigned char)from[escaped]);
            from += hex ? 4 : 1 + escaped;
        }
    }
    if (!file) {
        perror(path);
        exit(2);
    }
    fclose(file);
}

/* Puts bytes in the place of `removed` bytes. */
static void replace(size_t at, size_t removed, const uint8_t *bytes, size_t size)
{
    if (current.size - removed + size > MOST_BYTES)
        return;
    memmove(current.data + at + size, current.data + at + removed, current.size - at - removed);
    if (size > 0) /* or else bytes may be NULL */
        memcpy(current.data + at, bytes, size);
    current.size += size - removed;
}

static void mutate(void)
{
    static uint8_t copy[MOST_BYTES];
    size_t at = below(current.size + 1), left = current.size - at;
    size_t length = 1 + below(below(2) ? 8 : 256);
    uint8_t byte = (uint8_t)next_random();
    const struct bytes *other = &inputs[below(input_count)];
    size_t from = below(other->size), part = length < other->size - from ? length : other->size - from;
    const struct bytes *word = word_count > 0 ? &words[below(word_count)] : NULL;
    switch (below(7)) {
    case 0:
        replace(at, left > 0, &byte, 1);
        break;
    case 1:
        if (left > 0)
            current.data[at] ^= (uint8_t)(1U << below(8));
        break;
    case 2:
        replace(at, length < left ? length : left, NULL, 0);
        break;
    case 3: /* of this one again, elsewhere */
        length = length < left ? length : left;
        memcpy(copy, current.data + at, length);
        replace(below(current.size + 1), 0, copy, length);
        break;
    case 4: /* of another one */
        if (other->size > 0)
            replace(at, below(2) ? 0 : (part < left ? part : left), other->data + from, part);
        break;
    default:
        if (word)
            replace(at, below(2) ? 0 : (word->size < left ? word->size : left), word->data, word->size);
        break;
    }
}

int main(int argc, char **argv)
{
    if (argc < 4 || argc > 5) {
        fprintf(stderr, "usage: %s CASES SEED CORPUS [DICTIONARY]\n", argv[0]);
        return 2;
    }
    size_t cases = strtoul(argv[1], NULL, 10);
    unsigned long seed = strtoul(argv[2], NULL, 10);
    read_corpus(argv[3]);
    if (argc == 5)
        read_dictionary(argv[4]);
    for (const int *number = (const int[]){SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM, 0}; *number;
         ++number)
        signal(*number, keep_crash);
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC), told = dup(STDERR_FILENO);
    bool quiet = !getenv("FUZZ_VERBOSE"); /* messages are the targets' normal output */
    if (quiet)
        dup2(null, STDERR_FILENO);
    static uint8_t room[MOST_BYTES];
    for (size_t i = 0; i < input_count + cases; ++i) {
        const struct bytes *input = &inputs[i < input_count ? i : below(input_count)];
        random_state = seed * 0x9E3779B97F4A7C15U + i;
        if (i >= input_count)
            input = &inputs[below(input_count)];
        current = (struct bytes){room, input->size};
        memcpy(room, input->data, input->size);
        for (size_t mutations = i < input_count ? 0 : 1 + below(6); mutations > 0; --mutations)
            mutate();
        run(seed, i);
    }
    alarm(0);
    dprintf(told, "%zu inputs and %zu cases\n", input_count, cases);
    return 0;
}
