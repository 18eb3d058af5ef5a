// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/lagrange_terms.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/direction.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/tape.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// one tape with its memory
typedef struct part {
    hn_tape *tape;
    double *out, *work;
    long long runs;
} part;

struct hn_lagrange {
    const hn_system *sys;
    int nq, n;     // n: nv
    double *in;    // q, v, t
    part forces;   // M v, L_q
    part matrices; // entries of M and (M v)_q that are not identically zero
    int n_matrices, *at;
    double *full;                 // 2 n n: M, (M v)_q
    int n_pattern, *row, *column; // of their sum
    part rest; // Q_v, and beside it what it is the difference of, for judging rounding
    int constant;
};

// the expressions while they are built
typedef struct source {
    const hn_system *sys;
    hn_graph *g;
    hn_system_exprs ex;
    const hn_ex *M; // n x n
    int nq, n;
    int *symbols;              // q, v, t
    hn_ex *of_q;               // nq: derivatives by the entries of q, or their rates G v
    hn_ex *momentum, *kinetic; // n: M v, d/dq (1/2 v' M v)
    hn_ex *still;              // n: f(q, 0, t)
    hn_ex *list;               // 2 n n
    hn_ex *zero;
} source;

static void build_momentum(source *s) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        hn_ex sum = hn_num(0);
        for (int j = 0; j < n; j++) {
            const hn_ex v = hn_graph_symbol_expr(s->g, s->ex.v_symbols[j]);
            sum = hn_add(s->g, sum, hn_mul(s->g, s->M[(size_t)i * n + j], v));
        }
        s->momentum[i] = sum;
    }
}

static int place_of(const source *s, int symbol) {
    int i = 0;
    while (s->ex.q_symbols[i] != symbol) {
        i++;
        HN_ASSERT(i < s->nq);
    }
    return i;
}

// out (n) = of_q G: derivatives along the speeds
static void go_along_speeds(source *s, hn_ex *out) {
    for (int j = 0; j < s->n; j++) {
        int symbols[HN_DIRECTION_MOST];
        hn_ex seed[HN_DIRECTION_MOST], sum = hn_num(0);
        const int n = hn_direction_of_speed(s->sys, j, symbols, seed);
        for (int k = 0; k < n; k++) {
            const int i = place_of(s, symbols[k]);
            sum = hn_add(s->g, sum, hn_mul(s->g, s->of_q[i], seed[k]));
        }
        out[j] = sum;
    }
}

// of_q = G v
static void build_rates(source *s) {
    for (int i = 0; i < s->nq; i++) {
        s->of_q[i] = hn_num(0);
    }
    for (int j = 0; j < s->n; j++) {
        int symbols[HN_DIRECTION_MOST];
        hn_ex seed[HN_DIRECTION_MOST];
        const int n = hn_direction_of_speed(s->sys, j, symbols, seed);
        const hn_ex v = hn_graph_symbol_expr(s->g, s->ex.v_symbols[j]);
        for (int k = 0; k < n; k++) {
            const int i = place_of(s, symbols[k]);
            s->of_q[i] = hn_add(s->g, s->of_q[i], hn_mul(s->g, seed[k], v));
        }
    }
}

// The momentum of a ball turns with the axes that it is measured in: rate += omega x p.
static void turn_momenta(source *s, hn_ex *rate) {
    for (int at = 0; at < s->n; at++) {
        if (hn_system_position_of(s->sys, at) >= 0) {
            continue;
        }
        const hn_ex *p = s->momentum + at;
        for (int x = 0; x < 3; x++) {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            const hn_ex wy = hn_graph_symbol_expr(s->g, s->ex.v_symbols[at + y]);
            const hn_ex wz = hn_graph_symbol_expr(s->g, s->ex.v_symbols[at + z]);
            const hn_ex turn = hn_sub(s->g, hn_mul(s->g, wy, p[z]), hn_mul(s->g, wz, p[y]));
            rate[at + x] = hn_add(s->g, rate[at + x], turn);
        }
        at += 2;
    }
}

static void build_kinetic(source *s) {
    hn_ex twice = hn_num(0);
    for (int i = 0; i < s->n; i++) {
        const hn_ex v = hn_graph_symbol_expr(s->g, s->ex.v_symbols[i]);
        twice = hn_add(s->g, twice, hn_mul(s->g, v, s->momentum[i]));
    }
    hn_diff_reverse(s->g, hn_scale(0.5, twice), s->ex.q_symbols, s->nq, s->of_q);
    go_along_speeds(s, s->kinetic);
}

static hn_status compile(const source *s, int n_out, hn_arena *arena, part *p) {
    HN_TRY(hn_tape_compile(s->g, s->list, n_out, s->symbols, s->nq + s->n + 1, &p->tape));
    p->out = hn_arena_doubles(arena, (size_t)n_out);
    p->work = hn_arena_doubles(arena, hn_tape_work_size(p->tape));
    if (!p->out || !p->work) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(p->tape, p->work);
    return HN_OK;
}

static hn_status compile_forces(source *s, hn_arena *arena, part *p) {
    for (int i = 0; i < s->n; i++) {
        s->list[i] = s->momentum[i];
        s->list[s->n + i] = hn_add(s->g, s->kinetic[i], s->still[i]);
    }
    return compile(s, 2 * s->n, arena, p);
}

// what is not identically zero of M and (M v)_q, in s->list, moves to its front; its places are
// noted
static void pick_entries(hn_lagrange *l, source *s) {
    const int size = s->n * s->n;
    for (int i = 0; i < size; i++) {
        if (!hn_is_zero(s->list[i]) || !hn_is_zero(s->list[size + i])) {
            l->row[l->n_pattern] = i / s->n;
            l->column[l->n_pattern++] = i % s->n;
        }
    }
    for (int i = 0; i < 2 * size; i++) {
        if (!hn_is_zero(s->list[i])) {
            s->list[l->n_matrices] = s->list[i];
            l->at[l->n_matrices++] = i;
        }
    }
}

static hn_status compile_matrices(hn_lagrange *l, source *s, hn_arena *arena) {
    const size_t n = (size_t)s->n;
    memcpy(s->list, s->M, n * n * sizeof *s->list);
    for (size_t i = 0; i < n; i++) {
        hn_diff(s->g, s->momentum[i], s->ex.q_symbols, s->nq, s->of_q);
        go_along_speeds(s, s->list + n * n + i * n);
    }
    l->at = hn_arena_ints(arena, 2 * n * n);
    l->row = hn_arena_ints(arena, n * n);
    l->column = hn_arena_ints(arena, n * n);
    l->full = hn_arena_doubles(arena, 2 * n * n);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    pick_entries(l, s);
    return compile(s, l->n_matrices, arena, &l->matrices);
}

// Q_v, and the sum of the sizes of its parts, squared
static hn_status compile_rest(source *s, hn_arena *arena, part *p) {
    const int n = s->n;
    hn_ex *turned =
        s->list + n; // (dM/dt) v, and omega x p of balls: the rate of M v with v held fixed
    build_rates(s);
    hn_diff_forward(s->g, s->momentum, n, s->ex.q_symbols, s->of_q, s->nq, turned);
    turn_momenta(s, turned);
    for (int i = 0; i < n; i++) {
        const hn_ex moving = hn_sub(s->g, s->ex.f[i], s->still[i]);
        const hn_ex inertia = hn_sub(s->g, turned[i], s->kinetic[i]);
        const hn_ex parts[4] = {
            hn_mul(s->g, s->ex.f[i], s->ex.f[i]), hn_mul(s->g, s->still[i], s->still[i]),
            hn_mul(s->g, turned[i], turned[i]), hn_mul(s->g, s->kinetic[i], s->kinetic[i])};
        s->list[i] = hn_add(s->g, moving, inertia);
        s->list[n + i] = hn_sum(s->g, parts, 4);
    }
    return compile(s, 2 * n, arena, p);
}

static hn_status build(hn_lagrange *l, source *s, hn_arena *arena) {
    const int n = s->n;
    memcpy(s->symbols, s->ex.q_symbols, (size_t)s->nq * sizeof *s->symbols);
    memcpy(s->symbols + s->nq, s->ex.v_symbols, (size_t)n * sizeof *s->symbols);
    s->symbols[s->nq + n] = s->ex.t_symbol;

    // forces at rest separate the damping from the other forces
    for (int i = 0; i < n; i++) {
        s->zero[i] = hn_num(0);
    }
    hn_substitute(s->g, s->ex.f, n, s->ex.v_symbols, s->zero, n, s->still);
    build_momentum(s);
    build_kinetic(s);

    // tapes of forces, matrices and the rest
    hn_status status = hn_graph_status(s->g);
    HN_THEN(status, compile_forces(s, arena, &l->forces));
    HN_THEN(status, compile_matrices(l, s, arena));
    HN_THEN(status, compile_rest(s, arena, &l->rest));

    // a mass matrix of numbers alone is constant
    l->constant = 1;
    for (int i = 0; i < n * n; i++) {
        l->constant &= hn_is_number(s->M[i], NULL);
    }
    return status;
}

hn_status hn_lagrange_create(const hn_system *sys, hn_arena *arena, hn_lagrange **out) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t n = (size_t)info.nv, nq = (size_t)info.nq;
    hn_lagrange *l = hn_arena_get(arena, sizeof *l);
    source s = {.sys = sys,
                .g = hn_system_graph(sys),
                .ex = hn_system_get_exprs(sys),
                .nq = info.nq,
                .n = info.nv};

    // room for the expressions while they are built
    s.symbols = hn_arena_ints(arena, nq + n + 1);
    s.of_q = hn_arena_get(arena, nq * sizeof *s.of_q);
    s.momentum = hn_arena_get(arena, n * sizeof *s.momentum);
    s.kinetic = hn_arena_get(arena, n * sizeof *s.kinetic);
    s.still = hn_arena_get(arena, n * sizeof *s.still);
    s.zero = hn_arena_get(arena, n * sizeof *s.zero);
    s.list = hn_arena_get(arena, (2 * n * n + 2 * n) * sizeof *s.list);
    s.M = hn_system_dense_mass(sys, arena);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // the object itself outlives them
    l->sys = sys;
    l->nq = info.nq;
    l->n = info.nv;
    l->in = hn_arena_doubles(arena, nq + n + 1);
    const hn_status status = l->in ? build(l, &s, arena) : HN_ERR_MEMORY;
    if (status != HN_OK) {
        hn_lagrange_free(l);
        return status;
    }
    *out = l;
    return HN_OK;
}

void hn_lagrange_free(hn_lagrange *l) {
    if (l) {
        hn_tape_free(l->forces.tape);
        hn_tape_free(l->matrices.tape);
        hn_tape_free(l->rest.tape);
        l->forces.tape = l->matrices.tape = l->rest.tape = NULL;
    }
}

bool hn_lagrange_mass_is_constant(const hn_lagrange *l) {
    return l->constant;
}

static void run(hn_lagrange *l, part *p, double t, const double *q, const double *v) {
    const size_t n = (size_t)l->n, nq = (size_t)l->nq;
    memcpy(l->in, q, nq * sizeof *q);
    memcpy(l->in + nq, v, n * sizeof *v);
    l->in[nq + n] = t;
    hn_tape_eval(p->tape, l->in, p->out, p->work);
    p->runs++;
}

// -1 .. 1, the same every time
static double next_signed(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 8388608.0 - 1;
}

bool hn_lagrange_has_dissipation(hn_lagrange *l) {
    enum { STATES = 6 };
    unsigned seed = 1;
    for (int k = 0; k < STATES; k++) {
        double *in = l->in;
        for (int i = 0; i < l->nq + l->n; i++) {
            in[i] = next_signed(&seed);
        }
        (void)hn_system_normalise(l->sys, in);
        in[l->nq + l->n] = 0.1 * k;
        hn_tape_eval(l->rest.tape, in, l->rest.out, l->rest.work);
        for (int i = 0; i < l->n; i++) {
            const double left = fabs(l->rest.out[i]), size = sqrt(l->rest.out[l->n + i]);
            if (isfinite(size) && left > 1e-10 * size) {
                return true;
            }
        }
    }
    return false;
}

void hn_lagrange_forces(hn_lagrange *l, double t, const double *q, const double *v,
                        const double **momentum, const double **force) {
    run(l, &l->forces, t, q, v);
    *momentum = l->forces.out;
    *force = l->forces.out + l->n;
}

void hn_lagrange_matrices(hn_lagrange *l, double t, const double *q, const double *v,
                          const double **M, const double **B) {
    run(l, &l->matrices, t, q, v);
    for (int k = 0; k < l->n_matrices; k++) {
        l->full[l->at[k]] = l->matrices.out[k];
    }
    *M = l->full;
    *B = l->full + (size_t)l->n * l->n;
}

int hn_lagrange_pattern(const hn_lagrange *l, const int **rows, const int **cols) {
    *rows = l->row;
    *cols = l->column;
    return l->n_pattern;
}

const double *hn_lagrange_dissipation(hn_lagrange *l, double t, const double *q, const double *v) {
    run(l, &l->rest, t, q, v);
    return l->rest.out;
}

static double part_ops(const part *p) {
    return (double)p->runs * hn_tape_get_info(p->tape).ops;
}

double hn_lagrange_ops(const hn_lagrange *l) {
    return part_ops(&l->forces) + part_ops(&l->matrices) + part_ops(&l->rest);
}
