// SPDX-License-Identifier: GPL-3.0-or-later
// A linear system of blocks, [A B; C D] [x; y] = [b; c], graded by solving it with random matrices:
// any order of rows, any sign of an unknown, and any equivalent form is right.
#include "grade/parts/part_list.h"
#include "grade/parts/world.h"
#include "linalg/lu.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WORLDS = 3, MAX_BLOCKS = 4, MAX_SIZE = 24 };
static const double ALLOWED = 1e-7; // of the largest entry; systems of ten unknowns err by 1e-12

/// The solution of one system: one matrix for each unknown of the exercise.
typedef struct solution {
    int n;
    hn_matrix x[MAX_BLOCKS];
} solution;

static const cJSON *unknowns_of(const hn_part *p) {
    return cJSON_GetObjectItemCaseSensitive(p->node, "unknowns");
}

/// The number of the unknown that a word names, with its sign; -1 when there is none.
static int find_unknown(const hn_part *p, const cJSON *word, double *sign) {
    const char *name = cJSON_GetStringValue(word);
    const cJSON *m;
    int i = 0;
    name = name ? name + strspn(name, " ") : "";
    *sign = *name == '-' || strncmp(name, "−", 3) == 0 ? -1 : 1;
    name += *name == '-' ? 1 : *sign < 0 ? 3 : 0;
    name += strspn(name, " \\");
    cJSON_ArrayForEach(m, unknowns_of(p)) {
        if (strcmp(m->string, name) == 0 ||
            (strcmp(name, "λ") == 0 && !strcmp(m->string, "lambda")) ||
            (strcmp(name, "qddot") == 0 && !strcmp(m->string, "a"))) {
            return i;
        }
        i++;
    }
    return -1;
}

/// One system being assembled.
typedef struct system {
    const hn_part *p;
    hn_world *w;
    hn_part_result *r; ///< NULL: nobody is told
    int n_blocks, size, row_of[MAX_BLOCKS + 1], column_of[MAX_BLOCKS + 1];
    int unknown[MAX_BLOCKS];
    double sign[MAX_BLOCKS];
    double K[MAX_SIZE * MAX_SIZE], b[MAX_SIZE];
} system_t;

static int tell(system_t *s, const char *id, const char *format, const char *text) {
    if (s->r && strcmp(id, "unreadable") == 0) {
        hn_part_unreadable(s->r, format, text);
    } else if (s->r) {
        hn_part_wrong(s->r, id, 0, format, text);
    }
    return 0;
}

/// Evaluates a block; 0 after the reason has been told.
static int eval_block(system_t *s, const cJSON *node, hn_matrix *out) {
    hn_diag diag = {0};
    char number[40];
    const char *text = cJSON_GetStringValue(node);
    if (cJSON_IsNumber(node)) {
        snprintf(number, sizeof number, "%.17g", node->valuedouble);
        text = number;
    }
    if (!text) {
        return tell(s, "unreadable", "%s", "a block is no text in quotes");
    }
    const hn_status status = hn_world_eval(s->w, text, out, &diag);
    if (status == HN_OK) {
        return 1;
    }
    return tell(s, status == HN_ERR_INPUT ? "unreadable" : "shape", "%.300s", diag.message);
}

/// The order of the unknowns and the columns that they take.
static int read_unknowns(system_t *s, const cJSON *answer) {
    const cJSON *order = cJSON_GetObjectItemCaseSensitive(answer, "unknowns"), *m;

    // without an order of its own, an answer keeps that of the exercise
    const cJSON *list = order ? order : unknowns_of(s->p);
    int seen = 0;
    cJSON_ArrayForEach(m, list) {
        // each unknown once, with its sign
        double sign = 1;
        const int i = order ? find_unknown(s->p, m, &sign) : s->n_blocks;
        if (i < 0 || s->n_blocks == MAX_BLOCKS || (seen & 1 << i)) {
            return tell(s, "unreadable", "an entry of 'unknowns' is unknown or twice there: %.60s",
                        m->valuestring ? m->valuestring : "");
        }

        // its columns follow those of the unknown before
        const cJSON *size = cJSON_GetArrayItem(unknowns_of(s->p), i);
        const cJSON *n = cJSON_GetObjectItemCaseSensitive(
            cJSON_GetObjectItemCaseSensitive(s->p->node, "sizes"), size->valuestring);
        seen |= 1 << i;
        s->unknown[s->n_blocks] = i;
        s->sign[s->n_blocks] = sign;
        s->column_of[s->n_blocks + 1] = s->column_of[s->n_blocks] + (n ? n->valueint : 1);
        s->n_blocks++;
    }

    // all unknowns, and no more columns than there is room for
    s->size = s->column_of[s->n_blocks];
    return s->n_blocks == cJSON_GetArraySize(unknowns_of(s->p)) && s->size <= MAX_SIZE
               ? 1
               : tell(s, "shape", "%s", "not every unknown is there");
}

/// Copies a block into K; a number stands for that multiple of the identity, in a square place.
static int place_block(system_t *s, const hn_matrix *m, int row, int column, int height) {
    const int width = s->column_of[column + 1] - s->column_of[column];
    if (m->number && (m->x[0] == 0 || height == width)) {
        for (int i = 0; i < height && i < width; i++) {
            s->K[(s->row_of[row] + i) * s->size + s->column_of[column] + i] = m->x[0];
        }
        return 1;
    }
    if (m->number) {
        char text[120];
        snprintf(text, sizeof text,
                 "block %d, %d is a multiple of the identity, but its place is %d x %d", row + 1,
                 column + 1, height, width);
        return tell(s, "shape", "%s", text);
    }
    if (m->rows != height || m->cols != width) {
        char text[120];
        snprintf(text, sizeof text,
                 "block %d, %d is %d x %d, but its place is %d x %d: is it transposed?", row + 1,
                 column + 1, m->rows, m->cols, height, width);
        return tell(s, "transposed", "%s", text);
    }
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < m->cols; j++) {
            s->K[(s->row_of[row] + i) * s->size + s->column_of[column] + j] = m->x[i * m->cols + j];
        }
    }
    return 1;
}

/// One row of blocks with its right-hand side.
static int read_row(system_t *s, const cJSON *row, const cJSON *side, int i) {
    hn_matrix blocks[MAX_BLOCKS], b;

    // one block for each unknown
    if (cJSON_GetArraySize(row) != s->n_blocks) {
        return tell(s, "shape", "%s", "a row of blocks has another length than the unknowns");
    }

    // the height comes from any block that is no bare number
    int height = 0;
    for (int j = 0; j < s->n_blocks; j++) {
        if (!eval_block(s, cJSON_GetArrayItem(row, j), &blocks[j])) {
            return 0;
        }
        height = blocks[j].number || height ? height : blocks[j].rows;
    }

    // the right-hand side has the last word on it
    if (!eval_block(s, side, &b)) {
        return 0;
    }
    height = b.number ? height : b.rows;
    if (s->row_of[i] + height > s->size || height == 0 || (!b.number && b.cols != 1)) {
        return tell(s, "shape", "%s", "the rows of blocks do not make a square system");
    }

    // the entries, at their place in the whole system
    s->row_of[i + 1] = s->row_of[i] + height;
    for (int k = 0; k < height; k++) {
        s->b[s->row_of[i] + k] = b.number ? 0 : b.x[k];
    }
    for (int j = 0; j < s->n_blocks; j++) {
        if (!place_block(s, &blocks[j], i, j, height)) {
            return 0;
        }
    }
    return 1;
}

static int assemble(system_t *s, const cJSON *answer) {
    const cJSON *matrix = cJSON_GetObjectItemCaseSensitive(answer, "matrix"),
                *right = cJSON_GetObjectItemCaseSensitive(answer, "right");
    if (!cJSON_IsArray(matrix) || !cJSON_IsArray(right) || !read_unknowns(s, answer)) {
        return cJSON_IsArray(matrix) && cJSON_IsArray(right)
                   ? 0
                   : tell(s, "unreadable", "%s",
                          "expected {\"matrix\": [[...], ...], \"right\": [...]}");
    }
    if (cJSON_GetArraySize(matrix) != s->n_blocks || cJSON_GetArraySize(right) != s->n_blocks) {
        return tell(s, "shape", "%s", "the system needs as many rows of blocks as unknowns");
    }
    for (int i = 0; i < s->n_blocks; i++) {
        if (!read_row(s, cJSON_GetArrayItem(matrix, i), cJSON_GetArrayItem(right, i), i)) {
            return 0;
        }
    }
    return s->row_of[s->n_blocks] == s->size
               ? 1
               : tell(s, "shape", "%s", "the rows of blocks do not make a square system");
}

/// Solves the system of an answer in one world; 0 after the reason has been told.
static int solve(const hn_part *p, hn_world *w, const cJSON *answer, hn_part_result *r,
                 solution *out) {
    system_t s = {.p = p, .w = w, .r = r};
    int pivot[MAX_SIZE];
    double scale[MAX_SIZE];

    // the whole system, and its solution
    if (!assemble(&s, answer)) {
        return 0;
    }
    if (hn_lu_factor(s.size, s.K, pivot, scale) != HN_OK) {
        return tell(&s, "singular", "%s",
                    "this system is singular although J has full row rank and M is definite");
    }
    hn_lu_solve(s.size, s.K, pivot, s.b);

    // cut into the unknowns of the exercise, in their order and with their signs
    out->n = s.n_blocks;
    for (int k = 0; k < s.n_blocks; k++) {
        const int height = s.column_of[k + 1] - s.column_of[k];
        hn_matrix *x = &out->x[s.unknown[k]];
        *x = hn_matrix_new(w->arena, height, 1);
        for (int i = 0; i < height && x->x; i++) {
            x->x[i] = s.sign[k] * s.b[s.column_of[k] + i];
        }
    }
    return 1;
}

/// The reference solution by elimination: the formulas of "second".
static hn_status eliminate(const hn_part *p, hn_world *w, solution *out, hn_diag *diag) {
    const cJSON *second = cJSON_GetObjectItemCaseSensitive(p->node, "second"), *m;
    out->n = 0;
    cJSON_ArrayForEach(m, unknowns_of(p)) {
        if (out->n == MAX_BLOCKS) {
            return HN_ERR_INPUT;
        }
        HN_TRY(hn_world_eval(w, hn_part_text(second, m->string), &out->x[out->n++], diag));
    }
    return HN_OK;
}

static int agrees(const solution *a, const solution *b, int k, double sign) {
    return hn_world_distance(&a->x[k], &b->x[k], sign) <= ALLOWED;
}

/// Returns whether a wrong system has the solution that was given.
static bool is_solution(const hn_part *p, hn_world *w, const cJSON *answer, const solution *given) {
    solution wrong;
    bool same = solve(p, w, answer, NULL, &wrong);
    for (int k = 0; k < given->n && same; k++) {
        same = agrees(given, &wrong, k, 1);
    }
    return same;
}

/// Puts into `both` what `fault` changes of the reference, entry by entry. Returns whether no entry
/// of `both` has been changed before.
static bool put_changes(cJSON *both, const cJSON *reference, const cJSON *fault) {
    const cJSON *old = reference->child, *changed = fault->child;
    bool apart = true;
    for (cJSON *m = both->child, *next; m && old && changed && apart; m = next) {
        next = m->next;
        if (cJSON_IsArray(m) && cJSON_IsArray(old) && cJSON_IsArray(changed)) {
            apart = put_changes(m, old, changed);
        } else if (!cJSON_Compare(old, changed, true)) {
            apart = cJSON_Compare(m, old, true);
            cJSON *copy = cJSON_Duplicate(changed, true);
            apart &= copy && cJSON_ReplaceItemViaPointer(both, m, copy);
        }
        old = old->next;
        changed = changed->next;
    }
    return apart;
}

/// Names two listed mistakes in different entries that lead to the solution together.
static bool explain_pair(const hn_part *p, hn_world *w, const solution *given, hn_part_result *r) {
    const cJSON *reference = cJSON_GetObjectItemCaseSensitive(p->node, "answer"), *one, *two;
    bool found = false;
    for (int i = 0; (one = hn_part_fault_at(p, i)) != NULL && !found; i++) {
        for (int k = i + 1; (two = hn_part_fault_at(p, k)) != NULL && !found; k++) {
            cJSON *both = cJSON_Duplicate(reference, true);
            found = both &&
                    put_changes(both, reference, cJSON_GetObjectItemCaseSensitive(one, "answer")) &&
                    put_changes(both, reference, cJSON_GetObjectItemCaseSensitive(two, "answer")) &&
                    is_solution(p, w, both, given);
            cJSON_Delete(both);
            if (found) {
                const double share = hn_part_number(one, "share", 0);
                hn_part_wrong(r, hn_part_text(one, "id"), share * hn_part_number(two, "share", 0),
                              "two mistakes at once: %s; and %s", hn_part_text(one, "says"),
                              hn_part_text(two, "says"));
                r->alone = share;
            }
        }
    }
    return found;
}

/// Names the mistake: a listed one with the same solution, or two of them, or an unknown with the
/// wrong sign.
static void explain(const hn_part *p, hn_world *w, const solution *given, const solution *wanted,
                    hn_part_result *r) {
    // a listed mistake that leads to the same solution
    const cJSON *fault;
    for (int i = 0; (fault = hn_part_fault_at(p, i)) != NULL; i++) {
        if (is_solution(p, w, cJSON_GetObjectItemCaseSensitive(fault, "answer"), given)) {
            hn_part_wrong(r, hn_part_text(fault, "id"), hn_part_number(fault, "share", 0), "%s",
                          hn_part_text(fault, "says"));
            return;
        }
    }
    if (explain_pair(p, w, given, r)) {
        return;
    }

    // the unknowns that differ, and those that differ by the sign alone
    const char *wrong = "";
    int n = 0, signs = 0;
    for (int k = 0; k < wanted->n; k++) {
        const int right = agrees(given, wanted, k, 1);
        n += !right;
        signs += !right && agrees(given, wanted, k, -1);
        wrong = right ? wrong : cJSON_GetArrayItem(unknowns_of(p), k)->string;
    }

    // one wrong unknown can be named; more than one cannot
    if (n == 1 && signs == 1) {
        hn_part_wrong(r, "sign", 0.5, "%s comes out with the wrong sign", wrong);
    } else if (n == 1) {
        hn_part_wrong(r, "other", 0.25, "only %s comes out wrong", wrong);
    } else {
        hn_part_wrong(r, "other", 0, "the solution is another one: check every block and sign");
    }
}

static hn_status grade_worlds(const hn_part *p, const cJSON *given, hn_part_result *r,
                              hn_diag *diag) {
    for (int i = 0; i < WORLDS && r->right; i++) {
        hn_world w;
        solution found = {0}, wanted = {0};
        hn_status status = hn_world_init(&w, p, p->seed + 77 * (uint64_t)i, diag);
        status = status == HN_OK ? eliminate(p, &w, &wanted, diag) : status;
        if (status == HN_OK && !solve(p, &w, given, r, &found)) {
            r->right = 0;
        }
        for (int k = 0; k < wanted.n && status == HN_OK && r->right; k++) {
            if (!agrees(&found, &wanted, k, 1)) {
                explain(p, &w, &found, &wanted, r);
            }
        }
        hn_world_reset(&w);
        HN_TRY(status == HN_ERR_MEMORY ? status : status == HN_OK ? HN_OK : HN_ERR_INPUT);
    }
    return HN_OK;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    if (!hn_part_begin(r, n, given, "a system with the right solution")) {
        return HN_OK;
    }
    hn_part_right(r);
    return grade_worlds(p, given, r, diag);
}

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *m;
    hn_strbuf_add(b, "{\"matrix\": [[\"...\", ...], ...], \"right\": [\"...\", ...], "
                     "\"unknowns\": [");
    cJSON_ArrayForEach(m, unknowns_of(p)) {
        hn_strbuf_printf(b, "%s\"%s\"", m == unknowns_of(p)->child ? "" : ", ", m->string);
    }
    hn_strbuf_add(b, "]}; names:");
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, "matrices")) {
        hn_strbuf_printf(b, " %s", m->string);
    }
}

static cJSON *blank(const hn_part *p) {
    static const char *const MEMBERS[] = {"matrix", "right", "unknowns"};
    cJSON *out = cJSON_CreateObject();
    (void)p;
    for (size_t i = 0; i < sizeof MEMBERS / sizeof *MEMBERS; i++) {
        cJSON_AddItemToObject(out, MEMBERS[i], cJSON_CreateArray());
    }
    return out;
}

const hn_part_kind hn_part_blocks = {
    .name = "blocks",
    .fields = "sizes matrices unknowns answer second faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = blank,
    .right = hn_part_right_answer,
    .fault = hn_part_fault_answer,
    .prove = NULL, // grading compares the solved system with the elimination of "second"
};
