// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/repeated_question.h"

#include <math.h>
#include <string.h>

enum { OFTEN = 64 };
/// Difference of two answers, relative to the largest entry. A program that computes the same twice
/// gives the same bits; one whose threads add in another order differs by some hundred roundings,
/// times what the condition of its matrix makes of them.
static const double ALLOWED = 1e-9;

hn_status hn_repeated_question_init(hn_repeated_question *r, int nq, int nv, int nu,
                                    hn_arena *arena) {
    *r = (hn_repeated_question){.nq = nq, .nv = nv, .nu = nu};
    r->q = hn_arena_doubles(arena, (size_t)nq + 1);
    r->v = hn_arena_doubles(arena, (size_t)nv + 1);
    r->a = hn_arena_doubles(arena, (size_t)nu + 1);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

bool hn_repeated_question_is_due(long long id) {
    const bool is_power = (id & (id - 1)) == 0;
    return id > 1 && (is_power || id % OFTEN == 0);
}

void hn_repeated_question_keep(hn_repeated_question *r, long long id, double t, const double *q,
                               const double *v, const double *a) {
    r->id = id;
    r->t = t;
    memcpy(r->q, q, (size_t)r->nq * sizeof *q);
    memcpy(r->v, v, (size_t)r->nv * sizeof *v);
    memcpy(r->a, a, (size_t)r->nu * sizeof *a);
}

int hn_repeated_question_compare(const hn_repeated_question *r, const double *a) {
    double size = 0, worst = 0;
    int where = -1;
    for (int i = 0; i < r->nu; i++) {
        const double d = fabs(a[i] - r->a[i]);
        size = fmax(size, fmax(fabs(a[i]), fabs(r->a[i])));
        where = d > worst ? i : where;
        worst = fmax(worst, d);
    }
    return worst > ALLOWED * size ? where : -1;
}
