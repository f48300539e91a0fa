/* Common parts of solvers in lanes: names for each width, and memory for rows of vectors. */
#ifndef KINTRAFO_SOLVER_H
#define KINTRAFO_SOLVER_H

#include "vectors.h"

#include <stdlib.h>
#include <string.h>

/* The name of a function for this width. */
#define JOINED(name, width) name##width
#define NAME_OF(name, width) JOINED(name, width)

/* A row: where its address is stored, and its length. */
typedef struct {
    real **place;
    int count;
} part;

/*
 * Allocate rows, all zero, followed by some bytes, whose address is returned; null without memory. The first row
 * is to be freed.
 */
static void *reserve(const part *parts, size_t part_count, size_t more)
{
    size_t count = 0;
    for (size_t i = 0; i < part_count; ++i) {
        count += (size_t)parts[i].count;
    }
    size_t bytes = count * sizeof(real) + more;
    bytes += sizeof(real) - bytes % sizeof(real);
    real *memory = aligned_alloc(sizeof(real), bytes);
    if (!memory) {
        return NULL;
    }
    memset(memory, 0, bytes);
    for (size_t i = 0; i < part_count; ++i) {
        *parts[i].place = memory;
        memory += parts[i].count;
    }
    return memory;
}

#endif
