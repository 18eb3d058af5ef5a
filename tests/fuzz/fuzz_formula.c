// SPDX-License-Identifier: GPL-3.0-or-later
// A formula: parsed, differentiated forwards and backwards, evaluated by a tape, printed in three
// forms. Its own text reads back, and two evaluations have the same bits.
#include "fuzz/fuzz.h"

#include "expr/diff.h"
#include "expr/graph.h"
#include "expr/parse.h"
#include "expr/print.h"
#include "expr/tape.h"

#include <stdlib.h>
#include <string.h>

enum { N = 5, OUTPUTS = 1 + 2 * N, LONGEST_TEXT = 15000 };
static const char *const NAMES[N] = {"x", "y", "t", "l1", "th1"};
static const double AT[][N] = {{0.3, -1.7, 0.25, 1.1, 2.2},
                               {0, 0, 0, 0, 0},
                               {1e200, -1e200, 1e-310, 1e308, -0.0},
                               {-0.7, 2.5, 3, 0.5, -4}};

static int look(void *user, const char *name, hn_ex *out) {
    for (int i = 0; i < N; i++) {
        if (strcmp(name, NAMES[i]) == 0) {
            *out = hn_symbol(user, name, NULL);
            return 1;
        }
    }
    return 0;
}

static void evaluate(hn_graph *g, hn_ex e, const int symbols[N]) {
    hn_ex outputs[OUTPUTS] = {e};
    hn_tape *tape = NULL;
    hn_diff(g, e, symbols, N, outputs + 1);
    hn_diff_reverse(g, e, symbols, N, outputs + 1 + N);
    if (hn_graph_failed(g) || hn_tape_compile(g, outputs, OUTPUTS, symbols, N, &tape) != HN_OK) {
        return;
    }
    double *work = calloc(hn_tape_work_size(tape) + 1, sizeof *work), one[OUTPUTS], two[OUTPUTS];
    if (work) {
        hn_tape_prepare(tape, work);
        for (size_t k = 0; k < sizeof AT / sizeof *AT; k++) {
            hn_tape_eval(tape, AT[k], one, work);
            hn_tape_eval(tape, AT[k], two, work);
            if (memcmp(one, two, sizeof one) != 0) {
                hn_fuzz_fail("two evaluations differ");
            }
        }
    }
    free(work);
    hn_tape_free(tape);
}

static void print(hn_graph *g, hn_ex e, const hn_parse_opts *opts, const char *from) {
    hn_strbuf b;
    hn_ex again;
    hn_diag diag = {0};
    hn_strbuf_init(&b);
    hn_print(&b, g, e, HN_PRINT_TEXT, 0);
    if (!b.failed && b.n < LONGEST_TEXT &&
        hn_parse(g, hn_strbuf_text(&b), opts, &again, &diag) != HN_OK &&
        diag.status != HN_ERR_LIMIT) {
        hn_fuzz_fail("its own text is refused: %.200s: %s, from %s", hn_strbuf_text(&b),
                     diag.message, from);
    }
    hn_strbuf_reset(&b);
    hn_print(&b, g, e, HN_PRINT_LATEX, 6);
    hn_strbuf_reset(&b);
    hn_print(&b, g, e, HN_PRINT_C, 0);
    hn_strbuf_reset(&b);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size);
    hn_graph *g = hn_graph_create();
    const hn_parse_opts opts = {.lookup = look, .user = g, .known = NAMES, .n_known = N};
    int symbols[N];
    hn_ex e;
    hn_diag diag = {0};
    for (int i = 0; i < N; i++) {
        symbols[i] = hn_ex_symbol(g, hn_symbol(g, NAMES[i], NULL));
    }
    if (hn_parse(g, text, &opts, &e, &diag) == HN_OK) {
        evaluate(g, e, symbols);
        print(g, e, &opts, text);
    }
    hn_graph_free(g);
    free(text);
    return 0;
}
