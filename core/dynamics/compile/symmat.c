// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/symmat.h"

#include "expr/construct.h"

#include <stdbool.h>
#include <stdlib.h>

typedef struct slot {
    uint64_t key; ///< 0: empty
    hn_ex e;
} slot;

typedef struct neighbours {
    int n, cap;
    int *list;
} neighbours;

struct hn_symmat {
    int n, failed;
    size_t used, cap; ///< cap is a power of two
    slot *slots;
    neighbours *of;
};

static uint64_t key_of(int i, int j) {
    uint64_t low = (uint64_t)(i < j ? i : j), high = (uint64_t)(i < j ? j : i);
    return (low << 32 | high) + 1;
}

static slot *find(slot *slots, size_t cap, uint64_t key) {
    size_t at = (size_t)((key * 0x9e3779b97f4a7c15ull) >> 20) & (cap - 1);
    while (slots[at].key && slots[at].key != key) {
        at = (at + 1) & (cap - 1);
    }
    return &slots[at];
}

hn_symmat *hn_symmat_create(int n) {
    hn_symmat *m = calloc(1, sizeof *m);
    if (!m) {
        return NULL;
    }
    m->n = n;
    m->cap = 256;
    m->slots = calloc(m->cap, sizeof *m->slots);
    m->of = calloc((size_t)n + 1, sizeof *m->of);
    if (!m->slots || !m->of) {
        hn_symmat_free(m);
        return NULL;
    }
    return m;
}

void hn_symmat_free(hn_symmat *m) {
    if (m) {
        for (int i = 0; m->of && i < m->n; i++) {
            free(m->of[i].list);
        }
        free(m->of);
        free(m->slots);
        free(m);
    }
}

bool hn_symmat_failed(const hn_symmat *m) {
    return m->failed;
}

hn_ex hn_symmat_get(const hn_symmat *m, int i, int j) {
    const slot *s = find(m->slots, m->cap, key_of(i, j));
    return s->key ? s->e : hn_num(0);
}

static bool grow(hn_symmat *m) {
    slot *bigger = calloc(2 * m->cap, sizeof *bigger);
    if (!bigger) {
        return false;
    }
    for (size_t k = 0; k < m->cap; k++) {
        if (m->slots[k].key) {
            *find(bigger, 2 * m->cap, m->slots[k].key) = m->slots[k];
        }
    }
    free(m->slots);
    m->slots = bigger;
    m->cap *= 2;
    return true;
}

static void add_neighbour(hn_symmat *m, int i, int j) {
    neighbours *of = &m->of[i];
    if (of->n == of->cap) {
        int cap = of->cap ? 2 * of->cap : 8;
        int *list = realloc(of->list, (size_t)cap * sizeof *list);
        if (!list) {
            m->failed = 1;
            return;
        }
        of->list = list;
        of->cap = cap;
    }
    of->list[of->n++] = j;
}

void hn_symmat_set(hn_symmat *m, int i, int j, hn_ex e) {
    if (2 * m->used >= m->cap && !grow(m)) {
        m->failed = 1;
        return;
    }
    slot *s = find(m->slots, m->cap, key_of(i, j));
    if (!s->key) {
        s->key = key_of(i, j);
        m->used++;
        if (i != j) {
            add_neighbour(m, i, j);
            add_neighbour(m, j, i);
        }
    }
    s->e = e;
}

int hn_symmat_neighbours(const hn_symmat *m, int i, const int **list) {
    *list = m->of[i].list;
    return m->of[i].n;
}
