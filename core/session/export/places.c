// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/places.h"

#include "dynamics/compile/coordinates.h"
#include "export/code.h"
#include "expr/angles.h"
#include "expr/construct.h"
#include "session/export/calls.h"
#include "session/export/own_steps.h"
#include "session/export/scene_names.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LONGEST_PLACE = 24 };

// ---- what is put in the places ----

static const char *symbol_name(const hn_exporter *e, int symbol) {
    return hn_graph_symbol_name(hn_system_graph(e->sys), symbol);
}

/// One assignment `name = value` in a line of its own.
static void put_constant(hn_strbuf *b, const hn_exporter *e, int indent, const char *name,
                         const char *value) {
    hn_strbuf kept;
    hn_strbuf_init(&kept);
    hn_code_name(&kept, e->language, name);
    hn_strbuf_printf(b, "%*s", indent, "");
    hn_code_fill(b, e->language->constant, (const char *[]){hn_strbuf_text(&kept), value});
    b->failed |= kept.failed;
    hn_strbuf_reset(&kept);
}

/// Returns whether any of the terms depends on the symbol: a variable that nobody reads is a
/// warning in C.
static bool is_read(const hn_exporter *e, int symbol) {
    const hn_graph *g = hn_system_graph(e->sys);
    const int nv = e->info.nv, nc = e->info.nc;
    const hn_ex *const lists[] = {e->M, e->x.f,     e->x.phi,      e->x.phi_t,
                                  e->J, e->x.gamma, &e->x.kinetic, &e->x.potential};
    const int sizes[] = {nv * nv, nv, nc, nc, nc * nv, nc, 1, 1};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        for (int i = 0; i < sizes[k]; i++) {
            if (hn_depends_on(g, lists[k][i], symbol)) {
                return true;
            }
        }
    }
    return false;
}

static void end_comment(hn_strbuf *b, const hn_exporter *e) {
    hn_strbuf_printf(b, "%s\n", e->language->comment_end ? e->language->comment_end : "");
}

static void put_unit(hn_strbuf *b, const hn_exporter *e, const char *unit) {
    if (e->language->put_unit) {
        e->language->put_unit(b, unit);
    } else {
        hn_code_words(b, e->language, unit);
    }
}

/// Unit, meaning and formula of a parameter, as far as it has them, each behind a blank.
static void put_meaning(hn_strbuf *b, const hn_exporter *e, const hn_param *p) {
    const char *separator = " ";
    if (p->unit[0]) {
        hn_strbuf_add(b, separator);
        put_unit(b, e, p->unit);
        separator = ", ";
    }
    if (p->about[0]) {
        hn_strbuf_add(b, separator);
        hn_code_words(b, e->language, p->about);
        separator = ", ";
    }
    if (p->formula) {
        hn_strbuf_printf(b, "%scomputed from ", separator);
        hn_code_words(b, e->language, p->formula);
    }
}

static void put_parameters(hn_strbuf *b, const hn_exporter *e, int indent) {
    const hn_scene *scene = hn_model_scene(e->model);
    for (int i = 0; i < scene->n_params; i++) {
        const hn_param *p = &scene->params[i];
        const int symbol = hn_graph_find_symbol(hn_system_graph(e->sys), p->name);
        if (symbol < 0 || !is_read(e, symbol)) {
            continue; // it only shapes the start
        }
        hn_strbuf value;
        hn_strbuf_init(&value);
        hn_code_given(&value, e->language, p->value);
        put_constant(b, e, indent, p->name, hn_strbuf_text(&value));
        hn_strbuf_printf(b, " %s", e->language->comment);
        put_meaning(b, e, p);
        end_comment(b, e);
        b->failed |= value.failed;
        hn_strbuf_reset(&value);
    }
}

/// Entry i of q or v, as the language reads it.
static void entry_text(const hn_exporter *e, const char *array, int i, char out[32]) {
    hn_strbuf text;
    char index[16];
    hn_strbuf_init(&text);
    snprintf(index, sizeof index, "%d", i + e->language->first);
    hn_code_fill(&text, e->language->entry, (const char *[]){array, index});
    snprintf(out, 32, "%s", hn_strbuf_text(&text));
    hn_strbuf_reset(&text);
}

/// Says which symbol an entry is, in a comment or in a formula.
static void put_name(hn_strbuf *b, const hn_exporter *e, int indent, const char *array, int index,
                     const char *name) {
    char entry[32];
    entry_text(e, array, index, entry);
    hn_strbuf_printf(b, "%*s", indent, "");
    if (e->language->named) {
        hn_strbuf kept;
        hn_strbuf_init(&kept);
        hn_code_name(&kept, e->language, name);
        hn_code_fill(b, e->language->named, (const char *[]){entry, hn_strbuf_text(&kept)});
        hn_strbuf_add(b, "\n");
        b->failed |= kept.failed;
        hn_strbuf_reset(&kept);
        return;
    }
    hn_strbuf_printf(b, "%s %s ", e->language->comment, entry);
    hn_code_words(b, e->language, name);
    end_comment(b, e);
}

static void put_names(hn_strbuf *b, const hn_exporter *e, int indent) {
    for (int i = 0; i < e->info.nq; i++) {
        put_name(b, e, indent, "q", i, symbol_name(e, e->x.q_symbols[i]));
    }
    for (int i = 0; i < e->info.nv; i++) {
        put_name(b, e, indent, "v", i, symbol_name(e, e->x.v_symbols[i]));
    }
    hn_export_put_scene_names(b, e, indent);
}

static void put_unpack(hn_strbuf *b, const hn_exporter *e, int indent) {
    for (int i = 0; i < e->info.nq + e->info.nv; i++) {
        const bool is_v = i >= e->info.nq;
        const int k = is_v ? i - e->info.nq : i;
        const int symbol = is_v ? e->x.v_symbols[k] : e->x.q_symbols[k];
        char entry[32];
        if (is_read(e, symbol)) {
            entry_text(e, is_v ? "v" : "q", k, entry);
            put_constant(b, e, indent, symbol_name(e, symbol), entry);
            hn_strbuf_add(b, "\n");
        }
    }
}

/// Adds the entries of a term that are not zero; columns 0: a vector. Returns the new count.
static int add_entries(hn_code_entry *list, int n, const char *array, const hn_ex *value, int rows,
                       int columns) {
    for (int i = 0; i < rows * (columns ? columns : 1); i++) {
        if (!hn_is_zero(value[i])) {
            list[n++] = (hn_code_entry){.array = array,
                                        .row = columns ? i / columns : i,
                                        .column = columns ? i % columns : -1,
                                        .value = value[i]};
        }
    }
    return n;
}

/// The mass matrix without its lower half, where a language is there to read.
static int add_mass(hn_code_entry *list, const hn_exporter *e) {
    const int nv = e->info.nv;
    int n = add_entries(list, 0, "mass", e->M, nv, nv), kept = 0;
    for (int i = 0; i < n; i++) {
        if (!e->language->raised || list[i].row <= list[i].column) {
            list[kept++] = list[i];
        }
    }
    return kept;
}

/// Marks what is left to the student: a comment for each part, with its shape and meaning.
static void put_blanks(hn_strbuf *b, const hn_exporter *e, int indent) {
    static const struct {
        const char *array, *shape, *meaning;
    } parts[] = {{"mass", "NV x NV", "the mass matrix M, symmetric"},
                 {"force", "NV", "f = S' tau - C v - g: M a = f + J' lambda"},
                 {"jacobian", "NC x NV",
                  "J: the rate of phi is J v + closure_rate, with phi as closure below"},
                 {"bias", "NC", "gamma: the second time derivative of phi is J a + gamma"}};
    const int n = e->info.nc > 0 ? 4 : 2;
    for (int k = 0; k < n; k++) {
        char words[200];
        snprintf(words, sizeof words, "YOUR PART %d of %d: %s, %s, entries from %d: %s", k + 1, n,
                 parts[k].array, parts[k].shape, e->language->first, parts[k].meaning);
        hn_strbuf_printf(b, "%*s%s ", indent, "", e->language->comment);
        hn_code_words(b, e->language, words);
        end_comment(b, e);
        hn_strbuf_add(b, "\n");
    }
}

/// Formulas to read have sums and differences of angles.
static hn_status join_angles(const hn_exporter *e, hn_code_entry *list, int n) {
    hn_ex *value = hn_arena_get(e->arena, (size_t)(n + 1) * sizeof *value);
    if (!value) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        value[i] = list[i].value;
    }
    HN_TRY(hn_angles_join(hn_system_graph(e->sys), value, n));
    for (int i = 0; i < n; i++) {
        list[i].value = value[i];
    }
    return HN_OK;
}

static hn_status put_terms(hn_strbuf *b, const hn_exporter *e, int indent) {
    const int nv = e->info.nv, nc = e->info.nc;
    const size_t most = (size_t)nv * (size_t)nv + (size_t)nv + (size_t)nc * ((size_t)nv + 3) + 1;
    hn_code_entry *list = hn_arena_get(e->arena, most * sizeof *list);
    if (!list) {
        return HN_ERR_MEMORY;
    }

    // the order of the arrays is that of the texts
    hn_graph *g = hn_system_graph(e->sys);
    // the kinetic energy would give the mass matrix away
    const hn_ex energy = e->blanks ? e->x.potential : hn_add(g, e->x.kinetic, e->x.potential);
    int n = 0;
    if (e->blanks) {
        put_blanks(b, e, indent);
    } else {
        n = add_mass(list, e);
        n = add_entries(list, n, "force", e->x.f, nv, 0);
        n = add_entries(list, n, "jacobian", e->J, nc, nv);
        n = add_entries(list, n, "bias", e->x.gamma, nc, 0);
    }
    n = add_entries(list, n, "closure", e->x.phi, nc, 0);
    n = add_entries(list, n, "closure_rate", e->x.phi_t, nc, 0);
    n = add_entries(list, n, "energy", &energy, 1, 0);
    if (e->language->raised) {
        HN_TRY(join_angles(e, list, n));
    }
    const hn_code_symbols symbols = {e->x.q_symbols, e->x.v_symbols, e->info.nq, nv, e->x.t_symbol};
    return hn_code_write(b, g, e->language, &symbols, list, n, indent);
}

/// The time derivative of a unit quaternion e whose angular velocity w is given in the body's axes:
/// e' = e w / 2, row by row as signs and places of w.
static void put_quaternion_rates(hn_strbuf *b, const hn_exporter *e, int indent, int q, int v) {
    static const int place[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};
    static const char *const sign[4][3] = {
        {"-", " - ", " - "}, {"", " - ", " + "}, {"", " + ", " - "}, {"-", " + ", " + "}};
    for (int row = 0; row < 4; row++) {
        hn_strbuf value;
        char index[16];
        hn_strbuf_init(&value);

        // the right-hand side
        const char *times = e->language->times ? e->language->times : "*";
        hn_strbuf_printf(&value, "0.5%s(", times);
        for (int k = 0; k < 3; k++) {
            char e_text[32], w_text[32];
            entry_text(e, "q", q + place[row][k], e_text);
            entry_text(e, "v", v + k, w_text);
            hn_strbuf_printf(&value, "%s%s%s%s", sign[row][k], e_text, times, w_text);
        }
        hn_strbuf_add(&value, ")");

        // the assignment in the language
        snprintf(index, sizeof index, "%d", q + row + e->language->first);
        hn_strbuf_printf(b, "%*s", indent, "");
        hn_code_fill(b, e->language->vector,
                     (const char *[]){"rate", index, hn_strbuf_text(&value)});
        hn_strbuf_add(b, "\n");
        hn_strbuf_reset(&value);
    }
}

static void put_rates(hn_strbuf *b, const hn_exporter *e, int indent) {
    int q = 0;
    for (int v = 0; v < e->info.nv; v++) {
        char index[16], entry[32];
        if (hn_system_position_of(e->sys, v) < 0) {
            put_quaternion_rates(b, e, indent, q, v);
            q += 4;
            v += 2;
            continue;
        }
        entry_text(e, "v", v, entry);
        snprintf(index, sizeof index, "%d", q++ + e->language->first);
        hn_strbuf_printf(b, "%*s", indent, "");
        hn_code_fill(b, e->language->vector, (const char *[]){"rate", index, entry});
        hn_strbuf_add(b, "\n");
    }
}

static void put_numbers(hn_strbuf *b, const hn_exporter *e, const double *x, int n) {
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, i ? ", " : "");
        hn_code_given(b, e->language, x[i]);
    }
}

/// Declares the names that the lines of a block assign to; for languages that want one.
static void declare_assigned(hn_strbuf *b, const char *block, int indent) {
    while (*block) {
        const size_t n = strcspn(block, " [");
        if (n > 0 && block[n] == ' ') {
            hn_strbuf_printf(b, "%*sReal %.*s;\n", indent, "", (int)n, block);
        }
        block += strcspn(block, "\n");
        block += *block == '\n';
    }
}

static void put_parameter_locals(hn_strbuf *b, const hn_exporter *e, int indent) {
    hn_strbuf block;
    hn_strbuf_init(&block);
    put_parameters(&block, e, 0);
    declare_assigned(b, hn_strbuf_text(&block), indent);
    hn_strbuf_reset(&block);
}

static hn_status put_locals(hn_strbuf *b, const hn_exporter *e, int indent) {
    hn_strbuf block;
    hn_strbuf_init(&block);
    put_unpack(&block, e, 0);
    const hn_status status = put_terms(&block, e, 0);
    declare_assigned(b, hn_strbuf_text(&block), indent);
    hn_strbuf_reset(&block);
    return status;
}

// ---- places ----

/// Fills a place that takes lines of its own; *done says whether it is one.
static hn_status fill_block(hn_strbuf *b, const hn_exporter *e, const char *place, int indent,
                            bool *done) {
    static const struct {
        const char *name;
        void (*put)(hn_strbuf *, const hn_exporter *, int);
    } blocks[] = {{"PARAMETERS", put_parameters},
                  {"NAMES", put_names},
                  {"PARAMETER_LOCALS", put_parameter_locals},
                  {"UNPACK", put_unpack},
                  {"RATES", put_rates}};
    *done = true;
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        if (strcmp(blocks[i].name, place) == 0) {
            blocks[i].put(b, e, indent);
            return HN_OK;
        }
    }
    if (strcmp(place, "TERMS") == 0) {
        return put_terms(b, e, indent);
    }
    if (strcmp(place, "LOCALS") == 0) {
        return put_locals(b, e, indent);
    }
    *done = false;
    return HN_OK;
}

/// Fills a place inside a line.
static void fill_place(hn_strbuf *b, const hn_exporter *e, const char *place) {
    const hn_scene *scene = hn_model_scene(e->model);
    const hn_system_info *info = &e->info;
    const struct {
        const char *name;
        const double *x;
        int n;
    } lists[] = {{"START_Q", e->start.q, info->nq},
                 {"START_V", e->start.v, info->nv},
                 {"START_A", e->start.a, info->nv},
                 {"Q1", e->later.q, info->nq},
                 {"V1", e->later.v, info->nv},
                 {"A1", e->later.a, info->nv},
                 {"T1", &e->later.t, 1},
                 {"ALPHA", &e->alpha, 1},
                 {"BETA", &e->beta, 1},
                 {"ENERGY", &e->energy, 1}};
    const struct {
        const char *name;
        int value;
    } counts[] = {{"NQ", info->nq}, {"NV", info->nv}, {"NC", info->nc}};

    // numbers in a list, counts, words
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (strcmp(lists[i].name, place) == 0) {
            put_numbers(b, e, lists[i].x, lists[i].n);
            return;
        }
    }
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        if (strcmp(counts[i].name, place) == 0) {
            hn_strbuf_printf(b, "%d", counts[i].value);
            return;
        }
    }
    if (strcmp(place, "FUNCTIONS") == 0) {
        hn_export_put_functions(b, e->calls);
        return;
    }
    if (strncmp(place, "METHOD", 6) == 0) {
        hn_export_own_steps_put(b, e, place);
        return;
    }
    const bool is_scene = strcmp(place, "SCENE") == 0;
    HN_ASSERT(is_scene || strcmp(place, "TITLE") == 0);
    const char *words = is_scene ? scene->id : scene->title;
    hn_code_words(b, e->language, words ? words : scene->id);
}

/// The name of the place that begins at `at`, "@NAME@"; returns its length in the text, 0: none.
static size_t read_place(const char *at, size_t n, char out[LONGEST_PLACE]) {
    const size_t length =
        n > 2 && at[0] == '@' ? strspn(at + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") : 0;
    if (length == 0 || length >= LONGEST_PLACE || length + 2 > n || at[length + 1] != '@') {
        return 0;
    }
    snprintf(out, LONGEST_PLACE, "%.*s", (int)length, at + 1);
    return length + 2;
}

/// Copies a line of n characters, with its places filled.
static hn_status fill_line(hn_strbuf *b, const hn_exporter *e, const char *line, size_t n) {
    const size_t indent = strspn(line, " ");
    char place[LONGEST_PLACE];
    if (indent < n && read_place(line + indent, n - indent, place) == n - indent) {
        bool done;
        HN_TRY(fill_block(b, e, place, (int)indent, &done));
        if (done) {
            return HN_OK;
        }
    }

    // places inside the line
    for (size_t i = 0; i < n;) {
        const size_t length = read_place(line + i, n - i, place);
        if (length > 0) {
            fill_place(b, e, place);
            i += length;
        } else {
            hn_strbuf_add_n(b, line + i++, 1);
        }
    }
    hn_strbuf_add(b, "\n");
    return HN_OK;
}

/// Returns whether the lines behind @IF CONDITION@ are to be written.
static bool holds(const hn_exporter *e, const char *condition) {
    if (strcmp(condition, "BLANKS") == 0) {
        return e->blanks;
    }
    if (strcmp(condition, "SKELETON") == 0) {
        return e->skeleton;
    }
    if (strcmp(condition, "METHOD") == 0 || strcmp(condition, "OTHER_METHOD") == 0) {
        return e->steps.asked && (e->steps.why[0] == '\0') == (condition[0] == 'M');
    }
    if (strcmp(condition, "ORIENTATION") == 0) {
        return e->info.nq != e->info.nv;
    }
    if (strcmp(condition, "SIGN") == 0 || strcmp(condition, "STEP") == 0) {
        return e->calls & 1u << (condition[1] == 'I' ? HN_OP_SIGN : HN_OP_STEP);
    }
    if (strcmp(condition, "LOOPS") == 0) {
        return e->info.nc > 0;
    }
    if (strcmp(condition, "FUNCTIONS") == 0) {
        return hn_export_has_functions(e->calls);
    }
    return e->solver && strcasecmp(condition, e->solver->name) == 0;
}

/// Reads "@IF CONDITION@" from a line of n characters, spaces before it aside; false: another line.
static bool read_condition(const char *line, size_t n, char out[LONGEST_PLACE]) {
    static const char begin[] = "@IF ";
    const size_t indent = strspn(line, " "), from = indent + sizeof begin - 1;
    if (n < from + 2 || strncmp(line + indent, begin, sizeof begin - 1) != 0 ||
        line[n - 1] != '@') {
        return false;
    }
    snprintf(out, LONGEST_PLACE, "%.*s", (int)(n - 1 - from), line + from);
    return true;
}

/// Returns whether a line of n characters is this one, spaces before it aside.
static bool is_line(const char *line, size_t n, const char *word) {
    const size_t indent = strspn(line, " ");
    return indent < n && n - indent == strlen(word) &&
           strncmp(line + indent, word, n - indent) == 0;
}

hn_status hn_export_fill(hn_strbuf *b, const hn_exporter *e, const char *text) {
    // one bit for each condition that is open, the innermost lowest: 1 where lines are left out
    unsigned dropped = 0;
    while (*text) {
        const size_t n = strcspn(text, "\n");
        char condition[LONGEST_PLACE];
        if (read_condition(text, n, condition)) {
            dropped = dropped << 1 | !holds(e, condition);
        } else if (is_line(text, n, "@ELSE@")) {
            dropped ^= 1;
        } else if (is_line(text, n, "@END@")) {
            dropped >>= 1;
        } else if (!dropped) {
            HN_TRY(fill_line(b, e, text, n));
        }
        text += n + (text[n] == '\n');
    }
    return b->failed ? HN_ERR_MEMORY : HN_OK;
}
