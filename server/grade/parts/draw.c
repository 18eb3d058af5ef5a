// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/draw.h"

#include "base/hash.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/parse.h"
#include "grade/parts/spelling.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_DRAWS = 4000, MAX_CHARS = 2000, MAX_WORD = 200 };

double hn_draw_random(uint64_t seed, uint64_t k) {
    return (double)(hn_hash_mix(seed + 0x9E3779B97F4A7C15ull * (k + 1)) >> 11) * 0x1p-53;
}

// ---- formulas ----

static int find_name(const hn_draw *d, const char *name) {
    for (int i = 0; i < d->n_names; i++) {
        if (strcmp(d->name[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

/// theta1 stands for th1, omega1 for w1, and q1 for th1 where there is no q1.
static int find_alias(const hn_draw *d, const char *name) {
    char other[MAX_WORD];
    int found = -1;
    for (int i = 0; found < 0 && hn_spelling_alias(name, i, other, sizeof other); i++) {
        found = find_name(d, other);
    }
    return found;
}

static int lookup(void *user, const char *name, hn_ex *out) {
    hn_draw *d = user;
    char joined[MAX_WORD];
    int i = find_name(d, name);
    if (i < 0 && hn_spelling_join(name, joined, sizeof joined)) {
        i = find_name(d, joined);
        name = joined;
    }
    i = i < 0 ? find_alias(d, name) : i;
    if (i >= 0) {
        *out = hn_graph_symbol_expr(d->graph, i);
    }
    return i >= 0;
}

hn_status hn_draw_parse(hn_draw *d, const char *text, hn_ex *out, hn_diag *diag) {
    const hn_parse_opts opts = {.lookup = lookup,
                                .user = d,
                                .known = d->name,
                                .n_known = d->n_names,
                                .max_depth = 100,
                                .max_chars = MAX_CHARS};
    const hn_status status = hn_parse(d->graph, text, &opts, out, diag);
    return hn_graph_failed(d->graph) ? HN_ERR_MEMORY : status;
}

// ---- formulas of answers ----

/// The names of an answer; `clash` says which of them may be two, "" when none.
typedef struct answer_names {
    hn_draw *draw;
    char clash[160];
} answer_names;

/// The names from `first` on that `name` may stand for: how many, with the first two in `found`.
static int find_aliases(const hn_draw *d, const char *name, int first, int found[2]) {
    char other[MAX_WORD];
    int n = 0;
    for (int i = 0; hn_spelling_alias(name, i, other, sizeof other); i++) {
        const int k = find_name(d, other);
        if (k >= first && (n == 0 || k != found[0])) {
            found[n > 0] = k;
            n++;
        }
    }
    return n;
}

bool hn_draw_turns(const hn_draw *d, int i) {
    return strcmp(d->unit[i], "rad/s") == 0 || strcmp(d->unit[i], "rad") == 0;
}

static int find_answer_name(answer_names *a, const char *name) {
    const hn_draw *d = a->draw;
    char joined[MAX_WORD];
    int found[2] = {-1, -1}, i = find_name(d, name);
    if (i < 0 && hn_spelling_join(name, joined, sizeof joined)) {
        i = find_name(d, joined);
        name = joined;
    }

    // a given number keeps its name, but a given angle or rate yields to that of the part
    if (i >= d->n_outer || (i >= 0 && !hn_draw_turns(d, i))) {
        return i;
    }
    int n = find_aliases(d, name, d->n_outer, found);
    if (n == 0 && i >= 0) {
        return i;
    }
    n = n > 0 ? n : find_aliases(d, name, 0, found);
    if (n > 1) {
        snprintf(a->clash, sizeof a->clash, "'%.40s' may be %.40s or %.40s; write which", name,
                 d->name[found[0]], d->name[found[1]]);
    }
    return n == 1 ? found[0] : -1;
}

static int lookup_answer(void *user, const char *name, hn_ex *out) {
    answer_names *a = user;
    const int i = find_answer_name(a, name);
    if (i >= 0) {
        *out = hn_graph_symbol_expr(a->draw->graph, i);
    }
    return i >= 0;
}

hn_status hn_draw_parse_answer(hn_draw *d, const char *text, hn_ex *out, hn_diag *diag) {
    answer_names names = {.draw = d};
    const hn_parse_opts opts = {.lookup = lookup_answer,
                                .user = &names,
                                .known = d->name,
                                .n_known = d->n_names,
                                .max_depth = 100,
                                .max_chars = MAX_CHARS,
                                .shorten = "write it shorter"};
    hn_status status = hn_parse(d->graph, text, &opts, out, diag);
    if (status == HN_ERR_INPUT && names.clash[0]) {
        status = hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s", names.clash);
    }
    return hn_graph_failed(d->graph) ? HN_ERR_MEMORY : status;
}

const char *hn_draw_answer_name(hn_draw *d, const char *name) {
    answer_names names = {.draw = d};
    const int i = find_answer_name(&names, name);
    return i >= 0 ? d->name[i] : NULL;
}

double hn_draw_eval(hn_draw *d, hn_ex e, int state) {
    return hn_graph_eval(d->graph, e, d->value[state]);
}

void hn_draw_eval_all(hn_draw *d, hn_ex e, double out[HN_DRAW_STATES]) {
    hn_graph_eval_all(d->graph, e, d->value[0], d->n_states, HN_DRAW_NAMES, out);
}

hn_status hn_draw_value(hn_draw *d, const char *text, double *out, hn_diag *diag) {
    hn_ex e;
    HN_TRY(hn_draw_parse(d, text, &e, diag));
    *out = hn_draw_eval(d, e, 0);
    return HN_OK;
}

// ---- drawing ----

/// Source of the value of one name.
typedef struct source {
    double low, high, value;
    const cJSON *choose;
    int has_formula;
    hn_ex formula;
} source;

static hn_status refuse(const char *name, const char *what, hn_diag *diag) {
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/draw/%.60s", name);
    return hn_diag_set(diag, HN_ERR_INPUT, pointer, NULL, "the name '%.40s' %s", name, what);
}

static hn_status read_source(hn_draw *d, const cJSON *node, source *out, hn_diag *diag) {
    const cJSON *range = cJSON_GetObjectItem(node, "range"),
                *value = cJSON_GetObjectItem(node, "value"),
                *formula = cJSON_GetObjectItem(node, "formula");
    const int i = d->n_names;
    *out = (source){.choose = cJSON_GetObjectItem(node, "choose"), .low = 1, .high = 0};
    const cJSON *digits = cJSON_GetObjectItem(node, "digits");
    const char *unit = cJSON_GetStringValue(cJSON_GetObjectItem(node, "unit"));
    if (i == HN_DRAW_NAMES || find_name(d, node->string) >= 0) {
        return refuse(node->string, "is one too many, or given twice", diag);
    }

    // a range, a number, a list to choose from, or a formula of the names before
    if (cJSON_GetArraySize(range) == 2) {
        out->low = cJSON_GetNumberValue(range->child);
        out->high = cJSON_GetNumberValue(range->child->next);
        if (!(out->low <= out->high)) {
            return refuse(node->string, "has a range whose first number is above its second", diag);
        }
    } else if (cJSON_IsNumber(value)) {
        out->low = out->high = value->valuedouble;
    } else if (cJSON_IsString(formula)) {
        HN_TRY(hn_draw_parse(d, formula->valuestring, &out->formula, diag));
        out->has_formula = 1;
    } else if (cJSON_GetArraySize(out->choose) < 1) {
        return refuse(node->string, "needs range, value, choose or formula", diag);
    }
    d->name[i] = node->string;
    d->unit[i] = unit ? unit : "";
    d->digits[i] = cJSON_IsNumber(digits) ? digits->valueint : -1;
    d->origin[i] = out->has_formula        ? HN_DRAW_DERIVED
                   : cJSON_IsNumber(value) ? HN_DRAW_FIXED
                                           : HN_DRAW_DRAWN;
    d->n_names++;
    const hn_ex e = hn_symbol(d->graph, node->string, NULL);
    return hn_ex_symbol(d->graph, e) == i || hn_graph_failed(d->graph)
               ? HN_OK
               : refuse(node->string, "is given twice", diag);
}

static double draw_one(hn_draw *d, const source *s, int name, int state, double random) {
    double x = s->low + (s->high - s->low) * random;
    if (s->has_formula) {
        x = hn_draw_eval(d, s->formula, state);
    } else if (s->choose) {
        const int n = cJSON_GetArraySize(s->choose);
        x = cJSON_GetNumberValue(cJSON_GetArrayItem(s->choose, (int)(random * n)));
    }

    // what is printed is what is meant
    const double scale = d->digits[name] >= 0 ? pow(10, d->digits[name]) : 0;
    return scale > 0 ? floor(x * scale + 0.5) / scale : x;
}

static hn_status draw_states(hn_draw *d, int first, const source *sources, const hn_ex *conditions,
                             int n_conditions, uint64_t seed, hn_diag *diag) {
    uint64_t k = 0;
    int draws = 0;
    for (int s = 0; s < d->n_states; s++) {
        int fits = 0;
        while (!fits) {
            for (int i = first; i < d->n_names; i++) {
                d->value[s][i] = draw_one(d, &sources[i - first], i, s, hn_draw_random(seed, k++));
            }
            fits = 1;
            for (int c = 0; c < n_conditions; c++) {
                const int holds = hn_draw_eval(d, conditions[c], s) > 0;
                d->refused[c] += fits && !holds;
                fits &= holds;
            }
            if (!fits && ++draws > MAX_DRAWS) {
                return hn_diag_set(diag, HN_ERR_INPUT, "/conditions", "widen the ranges",
                                   "the conditions do not hold in %d draws", MAX_DRAWS);
            }
        }
    }
    return HN_OK;
}

/// The names of `outer`, the same in every state.
static void copy_outer(hn_draw *d, const hn_draw *outer) {
    for (int i = 0; outer && i < outer->n_names; i++) {
        d->name[i] = outer->name[i];
        d->unit[i] = outer->unit[i];
        d->digits[i] = outer->digits[i];
        d->origin[i] = outer->origin[i];
        hn_symbol(d->graph, d->name[i], NULL);
        for (int s = 0; s < d->n_states; s++) {
            d->value[s][i] = outer->value[0][i];
        }
        d->n_names++;
    }
    d->n_outer = d->n_names;
}

hn_status hn_draw_init(hn_draw *d, const cJSON *names, const cJSON *conditions,
                       const hn_draw *outer, int n_states, uint64_t seed, hn_diag *diag) {
    source sources[HN_DRAW_NAMES];
    hn_ex positive[HN_DRAW_CONDITIONS];
    int n_conditions = 0;
    memset(d, 0, sizeof *d);
    d->n_states = n_states < HN_DRAW_STATES ? n_states : HN_DRAW_STATES;
    d->graph = hn_graph_create();
    if (!d->graph) {
        return HN_ERR_MEMORY;
    }
    copy_outer(d, outer);

    // names in their order, then what must hold
    const int first = d->n_names;
    const cJSON *node;
    cJSON_ArrayForEach(node, names) {
        source s;
        HN_TRY(read_source(d, node, &s, diag));
        sources[d->n_names - 1 - first] = s;
    }
    cJSON_ArrayForEach(node, conditions) {
        if (!cJSON_IsString(node) || n_conditions == HN_DRAW_CONDITIONS) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/conditions", NULL,
                               "conditions are at most %d formulas in quotes", HN_DRAW_CONDITIONS);
        }
        const hn_status status =
            hn_draw_parse(d, node->valuestring, &positive[n_conditions++], diag);
        if (status == HN_ERR_INPUT && diag) {
            const hn_diag why = *diag;
            return hn_diag_set(diag, status, "/conditions", NULL, "the condition '%.60s': %s",
                               node->valuestring, why.message);
        }
        HN_TRY(status);
    }
    return draw_states(d, first, sources, positive, n_conditions, seed, diag);
}

void hn_draw_reset(hn_draw *d) {
    hn_graph_free(d->graph);
    d->graph = NULL;
}

int hn_draw_is_angle(const hn_draw *d, int name) {
    const char *unit = d->unit[name];
    return strcmp(unit, "rad") == 0 || strcmp(unit, "deg") == 0;
}

// ---- text ----

/// Returns what stands between the braces; 0 when it is neither a name nor a formula.
static int put_value(hn_strbuf *b, hn_draw *d, const char *word) {
    const int i = find_name(d, word);
    double x;
    if (i >= 0 && d->digits[i] >= 0) {
        hn_strbuf_printf(b, "%.*f", d->digits[i], d->value[0][i]);
    } else if (i >= 0) {
        hn_strbuf_printf(b, "%.6g", d->value[0][i]);
    } else if (word[0] == '=' && hn_draw_value(d, word + 1, &x, NULL) == HN_OK) {
        hn_strbuf_printf(b, "%.4g", x);
    } else {
        return 0;
    }
    return 1;
}

/// The word between the braces that begin at `text`; 0 bytes where there is none that fits.
static size_t read_word(const char *text, char word[MAX_WORD]) {
    const char *end = *text == '{' ? strchr(text, '}') : NULL;
    const size_t n = end ? (size_t)(end - text - 1) : 0;
    word[0] = 0;
    if (n > 0 && n < MAX_WORD) {
        snprintf(word, MAX_WORD, "%.*s", (int)n, text + 1);
    }
    return strlen(word);
}

bool hn_draw_find_unknown(hn_draw *d, const char *text, char *word, size_t size) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    char found[MAX_WORD];
    hn_strbuf value;
    hn_strbuf_init(&value);
    bool unknown = false;
    for (; *text && !unknown; text++) {
        const size_t n = read_word(text, found);
        unknown = n > 0 && (found[0] == '=' || strspn(found, letters) == n) &&
                  !put_value(&value, d, found);
    }
    if (unknown) {
        snprintf(word, size, "%s", found);
    }
    hn_strbuf_reset(&value);
    return unknown;
}

void hn_draw_text(hn_strbuf *b, hn_draw *d, const char *text) {
    while (*text) {
        char word[MAX_WORD];
        const size_t n = read_word(text, word);
        if (n > 0 && put_value(b, d, word)) {
            text += n + 2;
        } else {
            hn_strbuf_add_n(b, text++, 1);
        }
    }
}
