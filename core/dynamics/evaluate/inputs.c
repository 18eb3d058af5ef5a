// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/inputs.h"

#include <string.h>

static int count_params(const hn_system *sys) {
    return sys->opts.symbolic_params ? sys->scene->n_params : 0;
}

static void begin(const hn_system *sys, double *x, hn_inputs *in) {
    in->x = x;
    for (int i = 0; x && i < count_params(sys); i++) {
        x[sys->nq + sys->nv + 3 + i] = sys->scene->params[i].value;
    }
}

static void set_sizes(const hn_system *sys, hn_inputs *in) {
    const int pulled = HN_PULL_INPUTS * sys->n_pulls;
    *in = (hn_inputs){.nq = sys->nq,
                      .nv = sys->nv,
                      .n = sys->nq + sys->nv + 3 + count_params(sys) + pulled,
                      .n_pulled = pulled,
                      .pulls = sys->pulls};
}

void hn_inputs_put_pulls(hn_inputs *in, double t) {
    hn_pull_log_put(in->pulls, t, in->x + in->n - in->n_pulled);
}

hn_status hn_inputs_create(const hn_system *sys, hn_arena *arena, hn_inputs *in) {
    set_sizes(sys, in);
    begin(sys, hn_arena_doubles(arena, (size_t)in->n), in);
    return in->x ? HN_OK : HN_ERR_MEMORY;
}

static void list_symbols(const hn_system *sys, int *symbols) {
    memcpy(symbols, sys->q_symbols, (size_t)sys->nq * sizeof *symbols);
    memcpy(symbols + sys->nq, sys->v_symbols, (size_t)sys->nv * sizeof *symbols);
    int at = sys->nq + sys->nv;
    symbols[at++] = sys->t_symbol;
    symbols[at++] = sys->alpha_symbol;
    symbols[at++] = sys->beta_symbol;
    for (int i = 0; i < count_params(sys); i++) {
        symbols[at++] = hn_ex_symbol(sys->g, sys->params[i]);
    }
    for (int i = 0; i < HN_PULL_INPUTS * sys->n_pulls; i++) {
        symbols[at++] = hn_ex_symbol(sys->g, sys->pull_inputs[i]);
    }
}

hn_status hn_inputs_compile(const hn_system *sys, const hn_ex *outputs, int n_out, hn_arena *arena,
                            hn_inputs *in) {
    const hn_tape_check none = {0};
    return hn_inputs_compile_checked(sys, outputs, n_out, &none, arena, in);
}

hn_status hn_inputs_compile_checked(const hn_system *sys, const hn_ex *outputs, int n_out,
                                    const hn_tape_check *check, hn_arena *arena, hn_inputs *in) {
    set_sizes(sys, in);
    int *symbols = malloc((size_t)in->n * sizeof *symbols);
    if (!symbols) {
        return HN_ERR_MEMORY;
    }

    list_symbols(sys, symbols);
    hn_status status =
        hn_tape_compile_checked(sys->g, outputs, n_out, symbols, in->n, check, &in->tape);
    free(symbols);
    if (status != HN_OK) {
        return status;
    }

    // its workspace starts with the inputs
    double *work = hn_arena_doubles(arena, hn_tape_work_size(in->tape));
    if (!work) {
        hn_inputs_free(in);
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(in->tape, work);
    in->slots = hn_tape_output_slots(in->tape);
    begin(sys, work, in);
    return HN_OK;
}

void hn_inputs_free(hn_inputs *in) {
    hn_tape_free(in->tape);
    in->tape = NULL;
}
