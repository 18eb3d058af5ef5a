// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/native_emit.h"

#include "expr/lanes.h"
#include "expr/native_build.h"
#include "expr/tape_interpret.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// One function up to WHOLE instructions (about 0.3 s of gcc), pieces of PIECE beyond: gcc's time
// grows with the square of a function, and longer pieces give no quicker code (ladder of 200
// loops).
enum { WHOLE = 1500, PIECE = 100 };

// Up to FOUR angles go to one call in registers, more through memory in vectors of VECTOR.
enum { FOUR = 4, VECTOR = 8 };

typedef struct emitter {
    hn_strbuf *b;
    const hn_tape *tape;
    hn_lanes_set set;
    int width;           ///< doubles in a vector; 0: single states
    int32_t n_angles;    ///< the first instructions, found together; 0: each by itself
    int32_t *definition; ///< by slot: 2 * instruction (+ 1: the cosine) in this piece, or -1
    uint8_t *live;       ///< by slot: read by a later piece, or an output
    int32_t *starts;     ///< of the pieces, the last one first
    int32_t n_pieces;
} emitter;

/// Adds the place of a slot in the workspace: in lanes, of the present vector of its block.
static void put_place(const emitter *e, int slot) {
    hn_strbuf_printf(e->b, "w[%d]", e->width ? slot * (HN_LANES / e->width) : slot);
}

/// Adds what stands for a slot: an input or a value of an earlier piece, a constant, a name.
static void put_operand(const emitter *e, int slot) {
    const int constant = slot - e->tape->info.n_inputs;
    if (e->definition[slot] >= 0) {
        const int32_t at = e->definition[slot];
        hn_strbuf_printf(e->b, "%c%d", at & 1 ? 'c' : 'v', at / 2);
    } else if (constant < 0 || constant >= e->tape->n_constants) {
        put_place(e, slot);
    } else {
        const double value = e->tape->constants[constant];
        const char *all = e->width ? "ALL" : "";
        if (isinf(value)) {
            hn_strbuf_printf(e->b, "%s(%s1.0 / 0.0)", all, value > 0 ? "" : "-");
        } else {
            hn_strbuf_printf(e->b, "%s(%a)", all, value);
        }
    }
}

/// Adds an expression of the table of instructions with its operands a .. f put in.
static void put_expression(const emitter *e, const hn_tape_instruction *i, const char *text) {
    for (const char *c = text; *c; c++) {
        const bool alone =
            (c == text || !isalpha((unsigned char)c[-1])) && !isalpha((unsigned char)c[1]);
        if (alone && *c >= 'a' && *c <= 'f') {
            put_operand(e, i->v[1 + (*c - 'a')]);
        } else {
            hn_strbuf_add_n(e->b, c, 1);
        }
    }
}

/// Adds a function of single numbers lane by lane.
static void put_function_of_lanes(const emitter *e, int32_t k) {
    const hn_tape_instruction *i = &e->tape->code[k];
    const int code = i->code;
    hn_strbuf_printf(e->b, "lanes v%d; { const lanes x = ", k);
    put_operand(e, i->v[1]);
    if (code == TAPE_CALL2) {
        hn_strbuf_add(e->b, ", y = ");
        put_operand(e, i->v[2]);
    }
    hn_strbuf_printf(e->b, "; for (int i = 0; i < %d; i++) v%d[i] = ", e->width, k);
    if (code == TAPE_SIN || code == TAPE_COS) {
        hn_strbuf_add(e->b, code == TAPE_SIN ? "sin(x[i])" : "cos(x[i])");
    } else {
        hn_strbuf_printf(e->b, "call[%d]((const double[]){x[i]%s})", i->v[6],
                         code == TAPE_CALL2 ? ", y[i]" : "");
    }
    hn_strbuf_add(e->b, "; }\n");
}

/// Adds a function of one or two numbers.
static void put_function(const emitter *e, int32_t k) {
    const hn_tape_instruction *i = &e->tape->code[k];
    const int code = i->code;

    // two results at once, found before or here
    if (k < e->n_angles) {
        hn_strbuf_printf(e->b, "const double v%d = sine[%d], c%d = cosine[%d];\n", k, k, k, k);
        return;
    }
    if (code == TAPE_SINCOS) {
        hn_strbuf_printf(e->b, "double v%d, c%d; sincos(", k, k);
        put_operand(e, i->v[1]);
        hn_strbuf_printf(e->b, ", &v%d, &c%d);\n", k, k);
        return;
    }

    // one result
    hn_strbuf_printf(e->b, "const double v%d = ", k);
    if (code == TAPE_SIN || code == TAPE_COS) {
        put_expression(e, i, code == TAPE_SIN ? "sin(a)" : "cos(a)");
    } else {
        hn_strbuf_printf(e->b, "call[%d]((const double[]){", i->v[6]);
        put_expression(e, i, code == TAPE_CALL1 ? "a})" : "a, b})");
    }
    hn_strbuf_add(e->b, ";\n");
}

/// Adds instruction number k and notes where its results are.
static void put_instruction(emitter *e, int32_t k) {
    const hn_tape_instruction *i = &e->tape->code[k];
    if (i->code < TAPE_SINCOS) {
        hn_strbuf_printf(e->b, "const %s v%d = ", e->width ? "lanes" : "double", k);
        put_expression(e, i, hn_tape_get_code_info(i->code).text);
        hn_strbuf_add(e->b, ";\n");
    } else if (e->width) {
        put_function_of_lanes(e, k);
    } else {
        put_function(e, k);
    }
    e->definition[i->v[0]] = 2 * k;
    if (i->code == TAPE_SINCOS) {
        e->definition[i->v[2]] = 2 * k + 1;
    }
}

/// Steps over instruction k backwards: its results are needed no more, its operands are.
static void note_live(const emitter *e, int32_t k) {
    const hn_tape_instruction *i = &e->tape->code[k];
    e->live[i->v[0]] = 0;
    if (i->code == TAPE_SINCOS) {
        e->live[i->v[2]] = 0;
    }
    for (int n = hn_tape_operands(i); n > 0; n--) {
        e->live[i->v[n]] = 1;
    }
}

// ---- the check of the answer, see tape_check.h ----

static int end_of_pairs(const hn_tape_check *check) {
    return check->n_answer + 2 * check->n_pairs;
}

static void put_output(const emitter *e, int output) {
    put_operand(e, e->tape->outputs[output]);
}

/// Adds what is asked of output k, or of the pair that it begins.
static void put_question(const emitter *e, int k) {
    const hn_tape_check *check = &e->tape->check;
    if (k >= check->n_answer && k < end_of_pairs(check)) {
        hn_strbuf_add(e->b, "holds &= fabs(");
        put_output(e, k);
        hn_strbuf_printf(e->b, ") > %a * fabs(", check->pair);
        put_output(e, k + 1);
        hn_strbuf_add(e->b, ");\n");
        return;
    }
    hn_strbuf_add(e->b, "sum += ");
    put_output(e, k);
    hn_strbuf_add(e->b, ";\n");
    if (k >= check->n_answer) {
        hn_strbuf_add(e->b, "size = fabs(");
        put_output(e, k);
        hn_strbuf_add(e->b, k == end_of_pairs(check) ? "), least = most = size;\n"
                                                     : "), least = size < least ? size : least, "
                                                       "most = size > most ? size : most;\n");
    }
}

/// Adds all questions, and returns the answer: no number of a finite sum is infinite or a NaN. Only
/// where one function holds all, so that the values are still in registers: a long tape waits for
/// its instructions, and a loop over a table has fewer (ladder of 40 loops: 6 % of the time).
static void put_check(const emitter *e) {
    const hn_tape_check *check = &e->tape->check;
    if (e->width || e->n_pieces > 1) {
        hn_strbuf_printf(e->b, "return %d;\n", HN_TAPE_UNCHECKED);
        return;
    }
    hn_strbuf_add(e->b, "int holds = 1;\ndouble sum = 0, size, least, most, *const w = work;\n"
                        "(void)w, (void)size, (void)least, (void)most;\n");
    memset(e->definition, 0xff, (size_t)e->tape->info.slots * sizeof *e->definition);
    for (int k = 0; k < end_of_pairs(check) + check->n_rows; k++) {
        put_question(e, k);
        k += k >= check->n_answer && k < end_of_pairs(check);
    }
    if (check->n_rows > 0) {
        hn_strbuf_printf(e->b, "holds &= least > %a * most;\n", check->row);
    }
    hn_strbuf_printf(e->b, "return holds & (sum - sum == 0) ? %d : %d;\n", HN_TAPE_SURE,
                     HN_TAPE_UNSURE);
}

// ---- pieces ----

/// Adds a function for instructions first .. end - 1; afterwards `live` is that before `first`.
static void put_piece(emitter *e, int32_t first, int32_t end) {
    const bool is_all = first == 0 && end == e->tape->info.instructions;
    hn_strbuf_printf(e->b,
                     "static %s TARGET void piece%d(lanes *all, const "
                     "hn_call *call, const double *sine, const double *cosine) {\n"
                     "(void)call, (void)sine, (void)cosine;\nfor (int k = 0; k < %d; k++) {\n"
                     "lanes *const w = all + k;\n",
                     is_all ? "inline __attribute__((always_inline))" : "__attribute__((noinline))",
                     first, e->width ? HN_LANES / e->width : 1);
    memset(e->definition, 0xff, (size_t)e->tape->info.slots * sizeof *e->definition);
    for (int32_t k = first; k < end; k++) {
        put_instruction(e, k);
    }
    for (int slot = 0; slot < e->tape->info.slots; slot++) {
        if (e->definition[slot] >= 0 && e->live[slot]) {
            put_place(e, slot);
            hn_strbuf_add(e->b, " = ");
            put_operand(e, slot);
            hn_strbuf_add(e->b, ";\n");
        }
    }
    hn_strbuf_add(e->b, "}\n}\n");
}

/// Adds what the pieces are written in: numbers, or vectors of them.
static void put_head(const emitter *e) {
    static const char *const targets[HN_LANES_SETS] = {
        "", "__attribute__((target(\"avx2\")))",
        "__attribute__((target(\"avx512f,avx512dq,avx512vl\")))"};
    hn_strbuf_add(e->b, "typedef double (*hn_call)(const double *);\n"
                        "typedef void (*hn_many)(int, const double *, double *, double *);\n"
                        "typedef void (*hn_four)(double, double, double, double, double *, "
                        "double *);\n"
                        "extern double sin(double), cos(double);\n");
    // single numbers: results beside their operands; compiled for AVX-512 some tapes differ from
    // the interpreter in a last bit
    if (!e->width) {
        hn_strbuf_printf(e->b,
                         "extern double sqrt(double), fabs(double);\n"
                         "extern void sincos(double, double *, double *);\n"
                         "typedef double lanes;\n"
                         "#define TARGET %s\n",
                         targets[e->set == HN_LANES_PLAIN ? HN_LANES_PLAIN : HN_LANES_AVX2]);
        return;
    }
    hn_strbuf_printf(e->b,
                     "typedef double lanes __attribute__((vector_size(%d)));\n"
                     "#define TARGET %s\n"
                     "#define sqrt(a) ({ lanes r = (a); for (int i = 0; i < %d; i++) "
                     "r[i] = __builtin_sqrt(r[i]); r; })\n"
                     "#define ALL(a) ((lanes){",
                     e->width * (int)sizeof(double), targets[e->set], e->width);
    for (int i = 0; i < e->width; i++) {
        hn_strbuf_add(e->b, i ? ", a" : "a");
    }
    hn_strbuf_add(e->b, "})\n");
}

/// Adds what finds four angles at most: the last ones are filled up with the first.
static void put_four_angles(const emitter *e) {
    hn_strbuf_printf(e->b, "double sine[%d], cosine[%d];\n((hn_four)call[%d])(", FOUR, FOUR,
                     HN_NATIVE_FOUR);
    for (int32_t k = 0; k < FOUR; k++) {
        hn_strbuf_printf(e->b, "work[%d], ", e->tape->code[k < e->n_angles ? k : 0].v[1]);
    }
    hn_strbuf_add(e->b, "sine, cosine);\n");
}

/// Adds what finds the angles: whole vectors, the last filled up with zeros.
static void put_angles(const emitter *e) {
    if (e->n_angles == 0) {
        hn_strbuf_add(e->b, "const double *const sine = work, *const cosine = work;\n");
        return;
    }
    if (e->n_angles <= FOUR) {
        put_four_angles(e);
        return;
    }
    const int n = (e->n_angles + VECTOR - 1) / VECTOR * VECTOR;
    hn_strbuf_printf(e->b,
                     "_Alignas(64) double angle[%d], sine[%d], cosine[%d];\n"
                     "for (int i = %d; i < %d; i++) { angle[i] = 0; }\n",
                     n, n, n, (int)e->n_angles, n);
    for (int32_t k = 0; k < e->n_angles; k++) {
        hn_strbuf_printf(e->b, "angle[%d] = work[%d];\n", (int)k, e->tape->code[k].v[1]);
    }
    hn_strbuf_printf(e->b, "((hn_many)call[%d])(%d, angle, sine, cosine);\n",
                     HN_NATIVE_SINCOS + (int)e->set, n);
}

/// Returns whether an instruction is a piece by itself: sine and cosine of whole blocks.
static bool stands_alone(const emitter *e, int32_t k) {
    return e->width && e->tape->code[k].code == TAPE_SINCOS;
}

/// Returns where the piece begins that ends before instruction `end`.
static int32_t start_of(const emitter *e, int32_t end) {
    const int32_t longest = e->tape->info.instructions <= WHOLE ? WHOLE : PIECE;
    int32_t first = end - 1;
    while (!stands_alone(e, end - 1) && first % longest != 0 && !stands_alone(e, first - 1)) {
        first--;
    }
    return first;
}

/// Adds the function that calls the pieces.
static void put_whole(const emitter *e) {
    hn_strbuf_add(e->b, "TARGET int " HN_NATIVE_SYMBOL "(double *work, const hn_call *call) {\n");
    put_angles(e);
    for (int32_t p = e->n_pieces - 1; p >= 0; p--) {
        const hn_tape_instruction *i = &e->tape->code[e->starts[p]];
        if (stands_alone(e, e->starts[p])) {
            hn_strbuf_printf(e->b, "((hn_many)call[%d])(%d, work + %d, work + %d, work + %d);\n",
                             HN_NATIVE_SINCOS + (int)e->set, HN_LANES, HN_LANES * i->v[1],
                             HN_LANES * i->v[0], HN_LANES * i->v[2]);
        } else {
            hn_strbuf_printf(e->b, "piece%d((lanes *)work, call, sine, cosine);\n", e->starts[p]);
        }
    }
    hn_strbuf_add(e->b, "(void)work, (void)call, (void)sine, (void)cosine;\n");
    put_check(e);
    hn_strbuf_add(e->b, "}\n");
}

static void put_all(emitter *e) {
    for (int k = 0; k < e->tape->info.n_outputs; k++) {
        e->live[e->tape->outputs[k]] = 1;
    }
    put_head(e);

    // the last piece first: what crosses a cut is known only from behind
    for (int32_t end = e->tape->info.instructions, first; end > 0; end = first) {
        first = start_of(e, end);
        e->starts[e->n_pieces++] = first;
        if (!stands_alone(e, first)) {
            put_piece(e, first, end);
        }
        for (int32_t k = end - 1; k >= first; k--) {
            note_live(e, k);
        }
    }
    put_whole(e);
}

hn_status hn_native_emit(hn_strbuf *b, const hn_tape *tape, hn_native_form form) {
    for (int32_t i = 0; i < tape->n_constants; i++) {
        if (isnan(tape->constants[i])) {
            return HN_ERR_UNSUPPORTED; // which NaN it is could not be written
        }
    }
    const size_t slots = (size_t)tape->info.slots + 1;
    const hn_lanes_set set = form == HN_NATIVE_SINGLE
                                 ? hn_lanes_set_best() // for the angles found together
                                 : (hn_lanes_set)(form - HN_NATIVE_LANES);
    emitter e = {.b = b,
                 .tape = tape,
                 .set = set,
                 .width = form == HN_NATIVE_SINGLE ? 0 : hn_lanes_set_width(set),
                 .n_angles = form == HN_NATIVE_SINGLE && tape->four ? tape->n_angles : 0,
                 .definition = malloc(slots * sizeof *e.definition),
                 .live = calloc(slots, 1),
                 .starts = malloc(((size_t)tape->info.instructions + 1) * sizeof *e.starts)};
    const bool fits = e.definition && e.live && e.starts;
    if (fits) {
        put_all(&e);
    }
    free(e.definition);
    free(e.live);
    free(e.starts);
    return fits && !b->failed ? HN_OK : HN_ERR_MEMORY;
}
