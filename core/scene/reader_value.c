// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the loader: names with {..} filled in, numbers, formulas.

#include "scene/reader.h"

#include "base/hash.h"
#include "base/strbuf.h"
#include "base/visible.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static bool is_computable(double value) {
    return fabs(value) <= HN_SCENE_MAX_NUMBER;
}

static bool is_name_start(char c) {
    return isalpha((unsigned char)c) || c == '_';
}

static bool is_name(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

static const char *name_of(const hn_scene *s, hn_rd_meaning meaning, int index) {
    return meaning == HN_RD_PARAM        ? s->params[index].name
           : meaning == HN_RD_COORDINATE ? s->coordinates[index].name
                                         : s->coordinates[index].rate;
}

/// The slot that holds `name`, or the free one where it belongs.
static unsigned find_slot(const hn_reader *r, const char *name) {
    unsigned k = (unsigned)(hn_hash_mix(hn_hash_text(HN_HASH_START, name)) % HN_RD_SLOTS);
    while (r->slot[k].meaning != HN_RD_NOTHING &&
           strcmp(name_of(r->scene, r->slot[k].meaning, r->slot[k].index), name) != 0) {
        k = (k + 1) % HN_RD_SLOTS;
    }
    return k;
}

void hn_rd_put_name(hn_reader *r, hn_rd_meaning meaning, int index) {
    unsigned k = find_slot(r, name_of(r->scene, meaning, index));
    r->slot[k].meaning = (unsigned char)meaning;
    r->slot[k].index = index;
}

hn_rd_meaning hn_rd_find_name(const hn_reader *r, const char *name, int *index) {
    unsigned k = find_slot(r, name);
    *index = r->slot[k].index;
    return r->slot[k].meaning;
}

/// Finds the meaning of a name in a formula of the reader's present scope.
static int lookup(void *user, const char *name, hn_ex *out) {
    hn_reader *r = user;
    if (r->loop_name && strcmp(name, r->loop_name) == 0) {
        *out = hn_num((double)r->loop_value);
        return 1;
    }

    // a parameter is a number from here on
    int k;
    hn_rd_meaning meaning = hn_rd_find_name(r, name, &k);
    if (meaning == HN_RD_PARAM) {
        double value = 1;
        hn_rd_param_value(r, k, &value);
        *out = hn_num(value);
        return 1;
    }

    // an entry of a rotation vector is no value that a formula could use
    if (r->scope >= HN_RD_POSE && meaning == HN_RD_COORDINATE &&
        r->scene->coordinates[k].turn >= 0) {
        r->turn_refused = 1 + k;
        return 0;
    }

    // what the scope allows besides
    int found = r->scope >= HN_RD_TIME && strcmp(name, "t") == 0;
    found |= r->scope >= HN_RD_POSE && meaning == HN_RD_COORDINATE;
    found |= r->scope == HN_RD_STATE && meaning == HN_RD_RATE;
    if (found) {
        *out = hn_symbol(r->graph, name, NULL);
    }
    return found;
}

/// The names to suggest after a typing error.
static int known_names(hn_reader *r, hn_rd_scope scope, const char **names, int room) {
    int n = 0;
    if (r->loop_name) {
        names[n++] = r->loop_name;
    }
    for (int i = 0; i < r->scene->n_params && n < room; i++) {
        names[n++] = r->scene->params[i].name;
    }
    for (int i = 0; scope >= HN_RD_POSE && i < r->scene->n_coordinates && n + 1 < room; i++) {
        if (r->scene->coordinates[i].turn < 0) {
            names[n++] = r->scene->coordinates[i].name;
        }
        if (scope == HN_RD_STATE) {
            names[n++] = r->scene->coordinates[i].rate;
        }
    }
    return n;
}

/// Parses in a scope; a parameter's own faults may be reported on the way.
static hn_status parse(hn_reader *r, const char *text, hn_rd_scope scope, int suggest, hn_ex *out,
                       hn_diag *diag) {
    enum { ROOM = 512 };
    const char *known[ROOM];
    hn_rd_scope before = r->scope;
    r->scope = scope;
    r->turn_refused = 0;
    hn_parse_opts opts = {.lookup = lookup,
                          .user = r,
                          .known = known,
                          .n_known = suggest ? known_names(r, scope, known, ROOM) : 0};
    hn_status status = hn_parse(r->graph, text, &opts, out, diag);
    r->scope = before;
    return status;
}

/// Takes every name for a number.
static int know_any(void *user, const char *name, hn_ex *out) {
    hn_reader *r = user;
    *out = hn_symbol(r->graph, name, NULL);
    return 1;
}

static bool tell_parse_fault(hn_reader *r, const char *text, hn_rd_scope scope) {
    static const char *const allowed[] = {"only parameters may be used here",
                                          "only parameters and t may be used here",
                                          "only parameters, t and coordinates may be used here",
                                          "parameters, t, coordinates and rates may be used here"};
    static const char *const other_kind[] = {"the state or time", "the state", "a rate", ""};

    // a formula that would do in a wider scope: say which names are too many
    hn_diag diag = {0};
    hn_ex ignored;
    if (r->turn_refused == 0 && scope != HN_RD_STATE &&
        parse(r, text, HN_RD_STATE, 0, &ignored, &diag) == HN_OK) {
        return hn_rd_fault(r, allowed[scope], "the formula '%.80s' depends on %s", text,
                           other_kind[scope]);
    }
    if (r->turn_refused > 0) {
        return hn_rd_check_no_turn(r, r->turn_refused - 1);
    }

    // otherwise the parser says where, with names that are near
    memset(&diag, 0, sizeof diag);
    hn_status status = parse(r, text, scope, 1, &ignored, &diag);
    if (status == HN_ERR_MEMORY || hn_graph_failed(r->graph)) {
        r->oom = true;
        return false;
    }
    // it is about names only if any name would do
    hn_diag other = {0};
    hn_parse_opts any = {.lookup = know_any, .user = r};
    int names = hn_parse(r->graph, text, &any, &ignored, &other) == HN_OK;
    return hn_rd_fault(r, diag.hint[0] || !names ? diag.hint : allowed[scope],
                       "in the formula '%.80s'%s: %s", text, strlen(text) > 80 ? "..." : "",
                       diag.message);
}

bool hn_rd_formula(hn_reader *r, const char *text, hn_rd_scope scope, hn_quantity *out) {
    hn_diag diag = {0};
    hn_ex e = {0};
    hn_status status = parse(r, text, scope, 0, &e, &diag);
    if (status == HN_ERR_MEMORY || hn_graph_failed(r->graph)) {
        r->oom = true;
        return false;
    }
    if (status != HN_OK) {
        return tell_parse_fault(r, text, scope);
    }

    // a constant has its value now; anything else varies with the state
    double value = 0;
    if (!hn_is_number(e, &value)) {
        out->varies = true;
        if (scope == HN_RD_CONST) { // constant, but left unfolded by the graph
            out->varies = false;
            value = hn_graph_eval(r->graph, e, NULL);
        }
    }

    // a division by zero ends here
    if (!isfinite(value)) {
        return hn_rd_fault(r, NULL, "the formula '%.80s' has no finite value here", text);
    }
    if (!is_computable(value)) {
        return hn_rd_fault(r, NULL, "the formula '%.80s' is %g here, and 1e100 is the most", text,
                           value);
    }
    out->value = value;
    return true;
}

/// `raw` with every {formula} replaced by its whole value.
const char *hn_rd_fill(hn_reader *r, const char *raw) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    bool ok = 1;

    // text goes over as it is, each {formula} as its whole number
    for (const char *c = raw; *c && ok; c++) {
        const char *end = *c == '{' ? strchr(c, '}') : NULL;
        if (*c != '{') {
            hn_strbuf_add_n(&b, c, 1);
            continue;
        }
        char inner[80];
        if (!end || end - c - 1 >= (long)sizeof inner) {
            ok = hn_rd_fault(r, "as in \"crank{i}\" or \"tip{i+1}\"",
                             "'%.60s' has a '{' without a short formula and '}'", raw);
            break;
        }
        memcpy(inner, c + 1, (size_t)(end - c - 1));
        inner[end - c - 1] = '\0';
        hn_quantity q = {0};
        ok = hn_rd_formula(r, inner, HN_RD_CONST, &q);
        if (ok && !(fabs(q.value) <= 1e9 && q.value == floor(q.value))) {
            ok = hn_rd_fault(r, NULL, "{%s} in '%.60s' is %g, expected a whole number", inner, raw,
                             q.value);
        }
        hn_strbuf_printf(&b, "%lld", ok ? (long long)q.value : 0LL);
        c = end;
    }

    // kept, unless memory ran out on the way
    r->oom |= b.failed;
    const char *out = ok && !r->oom ? hn_rd_keep(r, hn_strbuf_text(&b)) : NULL;
    hn_strbuf_reset(&b);
    return out;
}

/// A formula with the repetition's name replaced by its number, so that it can be read outside the
/// repetition too.
static const char *settle_loop(hn_reader *r, const char *text) {
    if (!r->loop_name) {
        return hn_rd_keep(r, text);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);

    // word by word: a name, a number with its exponent, or one other character
    for (const char *c = text; *c;) {
        const char *end = c + 1;
        if (is_name_start(*c)) {
            while (is_name(*end)) {
                end++;
            }
        } else if (isdigit((unsigned char)*c) || *c == '.') { // 1e3 is a number, not a name e3
            end = c;
            while (isdigit((unsigned char)*end) || *end == '.') {
                end++;
            }
            if ((*end == 'e' || *end == 'E') && isdigit((unsigned char)end[1])) {
                end += 2;
            }
        }
        if (is_name_start(*c) && (size_t)(end - c) == strlen(r->loop_name) &&
            memcmp(c, r->loop_name, (size_t)(end - c)) == 0) {
            hn_strbuf_printf(&b, r->loop_value < 0 ? "(%lld)" : "%lld", r->loop_value);
        } else {
            hn_strbuf_add_n(&b, c, (size_t)(end - c));
        }
        c = end;
    }

    // kept, unless memory ran out on the way
    r->oom |= b.failed;
    const char *out = r->oom ? NULL : hn_rd_keep(r, hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
    return out;
}

bool hn_rd_quantity(hn_reader *r, const cJSON *node, hn_quantity *out, hn_rd_scope scope) {
    *out = (hn_quantity){.pointer = hn_rd_pointer(r)};

    // a number, or a formula
    if (cJSON_IsNumber(node)) {
        out->value = node->valuedouble;
        return is_computable(out->value) ||
               hn_rd_fault(r, NULL, "%g is too large to be computed with: 1e100 is the most",
                           out->value);
    }
    if (!cJSON_IsString(node)) {
        return hn_rd_fault(r, NULL, "expected a number or a formula in quotes, found %s",
                           hn_rd_kind(node));
    }

    // all formulas of a scene have a limit together
    r->n_text += strlen(node->valuestring);
    if (r->n_text > HN_RD_MAX_TEXT) {
        hn_rd_limit(r, "the formulas of the scene have more than %d characters in all",
                    HN_RD_MAX_TEXT);
        r->n_faults = HN_RD_MAX_FAULTS;
        return false;
    }

    // places of repeated parts filled in, then parsed
    const char *filled =
        strchr(node->valuestring, '{') ? hn_rd_fill(r, node->valuestring) : node->valuestring;
    const char *text = filled ? settle_loop(r, filled) : NULL;
    if (!text || !hn_rd_formula(r, text, scope, out)) {
        return false;
    }
    out->formula = text;
    return true;
}

bool hn_rd_member(hn_reader *r, const cJSON *object, const char *key, bool required,
                  double fallback, hn_quantity *out, hn_rd_scope scope) {
    const cJSON *node = hn_rd_get(object, key);
    *out = (hn_quantity){.value = fallback};
    if (!node) {
        return required ? hn_rd_fault(r, NULL, "the field '%s' is missing", key) : 1;
    }
    size_t mark = hn_rd_enter(r, key);
    bool ok = hn_rd_quantity(r, node, out, scope);
    hn_rd_leave(r, mark);
    return ok;
}

bool hn_rd_vector(hn_reader *r, const cJSON *node, hn_quantity out[3], hn_rd_scope scope) {
    memset(out, 0, 3 * sizeof *out);
    int n = cJSON_IsArray(node) ? cJSON_GetArraySize(node) : 0;
    if (n != 2 && n != 3) {
        return hn_rd_fault(r, "as in [1, 0, 0]", "expected a list of 2 or 3 numbers, found %s%s",
                           hn_rd_kind(node), cJSON_IsArray(node) ? " of another length" : "");
    }
    int ok = 1, i = 0;
    for (const cJSON *item = node->child; item; item = item->next, i++) {
        size_t mark = hn_rd_enter_index(r, i);
        ok &= hn_rd_quantity(r, item, &out[i], scope);
        hn_rd_leave(r, mark);
    }
    return ok;
}

const char *hn_rd_text(hn_reader *r, const cJSON *object, const char *key, bool required) {
    const cJSON *node = hn_rd_get(object, key);
    if (!node) {
        if (required) {
            hn_rd_fault(r, NULL, "the field '%s' is missing", key);
        }
        return NULL;
    }
    if (!cJSON_IsString(node)) {
        hn_rd_fault_at(r, key, NULL, "expected a text in double quotes, found %s",
                       hn_rd_kind(node));
        return NULL;
    }
    if (hn_has_control(node->valuestring, false)) {
        hn_rd_fault_at(r, key, "leave it out", "the text holds a control character");
        return NULL;
    }
    return hn_rd_keep(r, node->valuestring);
}

const char *hn_rd_name(hn_reader *r, const cJSON *object, const char *key, bool required) {
    const cJSON *node = hn_rd_get(object, key);
    if (!node || !cJSON_IsString(node)) {
        return hn_rd_text(r, object, key, required);
    }

    // braces are filled in before the length counts
    size_t mark = hn_rd_enter(r, key);
    const char *name = hn_rd_fill(r, node->valuestring);
    if (name && (name[0] == '\0' || strlen(name) > HN_RD_MAX_NAME)) {
        hn_rd_fault(r, NULL, "expected a name of 1 to %d characters, found %zu", HN_RD_MAX_NAME,
                    strlen(name));
        name = NULL;
    }

    // names appear in tables and links: no line breaks in them
    if (name && hn_has_control(name, true)) {
        hn_rd_fault(r, NULL, "a name holds a control character");
        name = NULL;
    }
    hn_rd_leave(r, mark);
    return name;
}

bool hn_rd_flag(hn_reader *r, const cJSON *object, const char *key) {
    const cJSON *node = hn_rd_get(object, key);
    if (node && !cJSON_IsBool(node)) {
        return hn_rd_fault_at(r, key, NULL, "expected true or false, found %s", hn_rd_kind(node));
    }
    return node && cJSON_IsTrue(node);
}
