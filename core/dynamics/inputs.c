#include "dynamics/inputs.h"

#include <string.h>

static int count_params(const hn_system *sys) {
    return sys->opts.symbolic_params ? sys->scene->n_params : 0;
}

hn_status hn_inputs_create(const hn_system *sys, hn_arena *arena, hn_inputs *in) {
    in->nv = sys->nv;
    in->n = 2 * sys->nv + 3 + count_params(sys);
    in->x = hn_arena_doubles(arena, (size_t)in->n);
    for (int i = 0; in->x && i < count_params(sys); i++) {
        in->x[2 * sys->nv + 3 + i] = sys->scene->params[i].value;
    }
    return in->x ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_inputs_compile(hn_system *sys, const hn_inputs *in, const hn_ex *outputs, int n_out,
                            hn_tape **tape) {
    int *symbols = malloc((size_t)in->n * sizeof *symbols);
    if (!symbols) {
        return HN_ERR_MEMORY;
    }
    memcpy(symbols, sys->q_symbols, (size_t)sys->nv * sizeof *symbols);
    memcpy(symbols + sys->nv, sys->v_symbols, (size_t)sys->nv * sizeof *symbols);
    int at = 2 * sys->nv;
    symbols[at++] = sys->t_symbol;
    symbols[at++] = sys->alpha_symbol;
    symbols[at++] = sys->beta_symbol;
    for (int i = 0; i < count_params(sys); i++) {
        symbols[at++] = hn_ex_symbol(sys->g, sys->params[i]);
    }
    hn_status status = hn_tape_compile(sys->g, outputs, n_out, symbols, in->n, tape);
    free(symbols);
    return status;
}

void hn_inputs_set(hn_inputs *in, double t, const double *q, const double *v, double alpha,
                   double beta) {
    size_t n = (size_t)in->nv;
    memcpy(in->x, q, n * sizeof *q);
    if (v) {
        memcpy(in->x + n, v, n * sizeof *v);
    } else {
        memset(in->x + n, 0, n * sizeof *in->x);
    }
    in->x[2 * n] = t;
    in->x[2 * n + 1] = alpha;
    in->x[2 * n + 2] = beta;
}
