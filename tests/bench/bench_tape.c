// SPDX-License-Identifier: GPL-3.0-or-later
// The tape against the compiler: one list of formulas, compiled by the C compiler into a function
// and typed into the expression graph. They are the accelerations and multipliers of the reference
// four-bar FB0 (absolute angles, uniform rods 1, 2 and 1.8 m of 1, 2 and 1.8 kg, span 2.2 m) with
// the saddle point factored by L D L' with pivots 1 x 1. Prints CSV.
//
// Results feed the next inputs, so that no evaluation can be hoisted; batches of the two alternate.
#include "expr/parse.h"
#include "expr/tape.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BATCHES = 31, EVALS = 20000, N_IN = 6, N_OUT = 5 };

#define INPUTS(X) X(th1) X(th2) X(th3) X(w1) X(w2) X(w3)

/// name, formula: C and the language of formulas agree on all of them
// clang-format off
#define FORMULAS(X) \
    X(s1, sin(th1)) X(c1, cos(th1)) X(s2, sin(th2)) X(c2, cos(th2)) X(s3, sin(th3)) \
    X(c3, cos(th3)) X(v1, w1 * w1) X(v2, w2 * w2) X(v3, w3 * w3) X(m11, 7.0 / 3.0) \
    X(m22, 8.0 / 3.0) X(m33, 1.944) X(m12, 2.0 * (c1 * c2 + s1 * s2)) \
    X(s12, 2.0 * (s1 * c2 - c1 * s2)) X(f1, -s12 * v2 - 24.525 * c1) \
    X(f2, s12 * v1 - 19.62 * c2) X(f3, -15.8922 * c3) \
    X(gx, 1.8 * c3 * v3 - c1 * v1 - 2.0 * c2 * v2) \
    X(gy, 1.8 * s3 * v3 - s1 * v1 - 2.0 * s2 * v2) X(a2, 2.0 * c2) X(b2, 2.0 * s2) \
    X(a3, 1.8 * c3) X(b3, 1.8 * s3) X(r1, 1.0 / m11) X(l21, m12 * r1) X(d2, m22 - l21 * m12) \
    X(r2, 1.0 / d2) X(r3, 1.0 / m33) X(l41, -s1 * r1) X(y2, -b2 - l41 * m12) X(l42, y2 * r2) \
    X(l43, b3 * r3) X(l51, c1 * r1) X(z2, a2 - l51 * m12) X(l52, z2 * r2) X(l53, -a3 * r3) \
    X(d4, s1 * l41 - y2 * l42 - b3 * l43) X(e54, s1 * l51 - y2 * l52 - b3 * l53) X(r4, 1.0 / d4) \
    X(l54, e54 * r4) X(d5, a3 * l53 - c1 * l51 - z2 * l52 - l54 * e54) X(u2, f2 - l21 * f1) \
    X(u4, -gx - l41 * f1 - l42 * u2 - l43 * f3) \
    X(u5, -gy - l51 * f1 - l52 * u2 - l53 * f3 - l54 * u4) X(x5, u5 / d5) \
    X(x4, u4 * r4 - l54 * x5) X(x3, f3 * r3 - l43 * x4 - l53 * x5) \
    X(x2, u2 * r2 - l42 * x4 - l52 * x5) X(x1, f1 * r1 - l21 * x2 - l41 * x4 - l51 * x5) \
    X(lam1, -x4) X(lam2, -x5)
// clang-format on

#define OUTPUTS(X) X(x1) X(x2) X(x3) X(lam1) X(lam2)

__attribute__((noinline)) static void by_hand(const double *in, double *out) {
    int at = 0;
#define READ(name) const double name = in[at++];
#define STATE(name, formula) const double name = formula;
#define WRITE(name) out[at++] = name;
    INPUTS(READ)
    FORMULAS(STATE)
    at = 0;
    OUTPUTS(WRITE)
}

#define TEXT(name) #name,
static const char *const inputs[] = {INPUTS(TEXT)};
static const char *const outputs[] = {OUTPUTS(TEXT)};

typedef struct named {
    const char *name, *formula;
    hn_ex value;
} named;

typedef struct typed {
    hn_graph *g;
    named *list;
    int n;
} typed;

/// A formula before this one, or an input.
static int look_up(void *user, const char *name, hn_ex *out) {
    const typed *t = user;
    for (int i = 0; i < t->n; i++) {
        if (strcmp(t->list[i].name, name) == 0) {
            *out = t->list[i].value;
            return 1;
        }
    }
    const int symbol = hn_graph_find_symbol(t->g, name);
    if (symbol >= 0) {
        *out = hn_graph_symbol_expr(t->g, symbol);
    }
    return symbol >= 0;
}

static hn_tape *compile(void) {
    named list[] = {
#define PAIR(name, formula) {#name, #formula, {0, 0}},
        FORMULAS(PAIR)};
    typed t = {.g = hn_graph_create(), .list = list};
    const hn_parse_opts opts = {.lookup = look_up, .user = &t};
    hn_ex out[N_OUT];
    int symbols[N_IN];
    for (int i = 0; i < N_IN; i++) {
        symbols[i] = hn_ex_symbol(t.g, hn_symbol(t.g, inputs[i], NULL));
    }
    hn_diag diag = {0};
    for (; t.n < (int)(sizeof list / sizeof *list); t.n++) {
        if (hn_parse(t.g, list[t.n].formula, &opts, &list[t.n].value, &diag) != HN_OK) {
            fprintf(stderr, "%s: %s\n", list[t.n].formula, diag.message);
            exit(3);
        }
    }
    hn_tape *tape = NULL;
    for (int i = 0; i < N_OUT; i++) {
        if (!look_up(&t, outputs[i], &out[i])) {
            exit(3);
        }
    }
    if (hn_tape_compile(t.g, out, N_OUT, symbols, N_IN, &tape) != HN_OK) {
        exit(3);
    }
    hn_graph_free(t.g);
    return tape;
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void feed_back(double *in, const double *out) {
    for (int i = 0; i < 3; i++) {
        in[i] += 1e-12 * in[3 + i]; // angles that stay would be found once only
        in[3 + i] += 1e-12 * out[i];
    }
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *v) {
    qsort(v, BATCHES, sizeof *v, ascending);
    return v[BATCHES / 2];
}

int main(void) {
    static const double start[N_IN] = {1, 0.498324904142577, 1.516841745037813, 2, -0.3, 0.9};
    hn_tape *tape = compile();
    double *work = calloc(hn_tape_work_size(tape), sizeof *work);
    double in_hand[N_IN], in_tape[N_IN], hand[N_OUT], taped[N_OUT];
    double t_hand[BATCHES], t_tape[BATCHES], worst = 0;
    if (!work) {
        return 3;
    }
    hn_tape_prepare(tape, work);
    memcpy(in_hand, start, sizeof start);
    memcpy(in_tape, start, sizeof start);
    for (int k = 0; k < BATCHES; k++) {
        double from = seconds();
        for (int i = 0; i < EVALS; i++) {
            by_hand(in_hand, hand);
            feed_back(in_hand, hand);
        }
        t_hand[k] = (seconds() - from) / EVALS * 1e9;
        from = seconds();
        for (int i = 0; i < EVALS; i++) {
            hn_tape_eval(tape, in_tape, taped, work);
            feed_back(in_tape, taped);
        }
        t_tape[k] = (seconds() - from) / EVALS * 1e9;
    }
    for (int i = 0; i < N_OUT; i++) { // the same numbers, or the comparison means nothing
        worst = fmax(worst, fabs(hand[i] - taped[i]) / (1 + fabs(hand[i])));
    }
    const hn_tape_info info = hn_tape_get_info(tape);
    const double ns_hand = median(t_hand), ns_tape = median(t_tape);
    printf("what,ops,instructions,ns_per_eval,ratio_to_hand,difference\n");
    printf("hand,,,%.1f,1.00,0\n", ns_hand);
    printf("tape,%d,%d,%.1f,%.2f,%.1e\n", info.ops, info.instructions, ns_tape, ns_tape / ns_hand,
           worst);
    free(work);
    hn_tape_free(tape);
    return 0;
}
