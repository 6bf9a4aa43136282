#ifndef WORDS_H
#define WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry.h"

/* A case's inputs and outputs are records of 32-bit words, which functions.comp reads and writes in the same
 * order. */
union word {
    float number;
    uint32_t integer;
};

enum { MOST_WORDS = 64 };

struct word_name {
    const char *text;
    bool integer;
};

/* Where the next word goes, and its name if anyone wants to know. */
struct word_writer {
    union word *next;
    struct word_name *names; /* or NULL */
};

static inline void put_name(struct word_writer *writer, const char *name, bool integer)
{
    if (writer->names)
        *writer->names++ = (struct word_name){name, integer};
}

static inline void put_real(struct word_writer *writer, const char *name, real value)
{
    put_name(writer, name, false);
    (writer->next++)->number = value;
}

static inline void put_integer(struct word_writer *writer, const char *name, uint32_t value)
{
    put_name(writer, name, true);
    (writer->next++)->integer = value;
}

static inline void put_vector(struct word_writer *writer, const char *name, struct vec3 value)
{
    put_real(writer, name, value.x);
    put_real(writer, name, value.y);
    put_real(writer, name, value.z);
}

static inline void put_vec4(struct word_writer *writer, const char *name, layout_vec4 value)
{
    put_vector(writer, name, vector_of(value));
    put_real(writer, name, value.w);
}

static inline real get_real(const union word **next)
{
    return (*next)++->number;
}

static inline uint32_t get_integer(const union word **next)
{
    return (*next)++->integer;
}

static inline struct vec3 get_vector(const union word **next)
{
    struct vec3 vector;
    vector.x = get_real(next);
    vector.y = get_real(next);
    vector.z = get_real(next);
    return vector;
}

static inline layout_vec4 get_vec4(const union word **next)
{
    struct vec3 xyz = get_vector(next);
    return (layout_vec4){xyz.x, xyz.y, xyz.z, get_real(next)};
}

#endif
