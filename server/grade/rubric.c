// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/rubric.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "base/suggest.h"
#include "grade/parts/part.h"
#include "grade/repeated_member.h"
#include "grade/toml_text.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 1 << 16, MAX_DEPTH = 8 };
static const double TIGHTEST = 1e-9; // references are confirmed to this share of their size
static const double LOOSEST = 0.5;

struct hn_rubric {
    hn_strbuf text;
    cJSON *root;
    uint64_t hash;
    char file[80];        ///< its name, without folders
    bool toml;            ///< suggestions are written as TOML
    const char *exercise; ///< borrowed from the tree
};

// ---- faults ----

/// The quote before the key `name` that stands `depth` brackets inside `text`: of a whole text, or
/// of the value that follows, at whose end the search stops. NULL: there is none.
static const char *find_key(const char *text, int depth, const char *name) {
    int inside = 0;
    for (const char *at = text; *at && !(inside == 0 && *at == ','); at++) {
        if (*at == '"') {
            const char *begin = at++;
            while (*at && *at != '"') {
                at += *at == '\\' && at[1] ? 2 : 1;
            }
            if (!*at) {
                return NULL;
            }
            const char *behind = at + 1 + strspn(at + 1, " \t\r\n");
            const size_t n = (size_t)(at - begin) - 1;
            if (inside == depth && *behind == ':' && n == strlen(name) &&
                strncmp(begin + 1, name, n) == 0) {
                return begin;
            }
        }
        inside += (*at == '{' || *at == '[') - (*at == '}' || *at == ']');
        if (inside < 0) {
            return NULL;
        }
    }
    return NULL;
}

/// The line of `key` within the field `section`; of the field itself for key NULL. Keys of parts
/// have members of their own, and a name that is there twice stands at any depth.
static int line_of(const hn_rubric *r, const char *section, const char *key) {
    const char *text = hn_strbuf_text(&r->text), *at = text, *found = NULL;
    for (int depth = 1; depth <= MAX_DEPTH && !found; depth++) {
        found = find_key(text, depth, section);
    }
    at = found ? found : at;
    if (found && key) {
        const char *value = found + strlen(section) + 2;
        const char *inner = find_key(value, 1, key);
        inner = inner ? inner : find_key(value, 2, key);
        at = inner ? inner : at;
    }
    int line = 1;
    for (const char *q = text; q < at; q++) {
        line += *q == '\n';
    }
    return line;
}

hn_status hn_rubric_fault(const hn_rubric *r, hn_diags *diags, const char *section, const char *key,
                          const char *hint, const char *format, ...) {
    char what[HN_DIAG_MESSAGE];
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    return hn_diags_add(diags, HN_ERR_INPUT, section, hint, "line %d: %.300s",
                        line_of(r, section, key), what);
}

/// Returns the line that a fault names; that of one without a line is behind all others.
static int line_of_fault(const hn_diag *diag) {
    int line = INT_MAX;
    return sscanf(diag->message, "line %d:", &line) == 1 ? line : INT_MAX;
}

void hn_rubric_sort_faults(hn_diags *diags) {
    for (int i = 1; i < diags->n; i++) {
        const hn_diag one = diags->item[i];
        int k = i;
        for (; k > 0 && line_of_fault(&diags->item[k - 1]) > line_of_fault(&one); k--) {
            diags->item[k] = diags->item[k - 1];
        }
        diags->item[k] = one;
    }
}

const cJSON *hn_rubric_section(const hn_rubric *r, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(r->root, name);
}

// ---- reading ----

static const char *const FIELDS[] = {"rubric", "exercise", "total", "points",    "tolerance",
                                     "shares", "hints",    "about", "visibility"};
enum { N_FIELDS = sizeof FIELDS / sizeof *FIELDS };

/// Gradescope's words.
static const char *const VISIBILITIES[] = {"visible", "hidden", "after_due_date",
                                           "after_published"};
enum { N_VISIBILITIES = sizeof VISIBILITIES / sizeof *VISIBILITIES };

static hn_status check_visibilities(const hn_rubric *r, hn_diags *diags) {
    const cJSON *m;
    hn_status status = HN_OK;
    cJSON_ArrayForEach(m, hn_rubric_section(r, "visibility")) {
        const char *word = cJSON_GetStringValue(m);
        bool known = false;
        for (int i = 0; word && i < N_VISIBILITIES; i++) {
            known |= strcmp(word, VISIBILITIES[i]) == 0;
        }
        if (!known) {
            char hint[HN_DIAG_HINT];
            hn_suggest_or_list(hint, word ? word : "", VISIBILITIES, N_VISIBILITIES, "one of: ");
            status = hn_rubric_fault(r, diags, "visibility", m->string, hint,
                                     "the visibility of part %.40s is no word of Gradescope's",
                                     m->string ? m->string : "");
        }
    }
    return status;
}

/// A name that is there twice: one of its values would be ignored.
static hn_status check_once(const hn_rubric *r, hn_diags *diags) {
    const char *name = hn_repeated_member_find(r->root);
    return name ? hn_rubric_fault(r, diags, name, NULL, "keep the one that counts",
                                  "'%.40s' is there more than once in one object", name)
                : HN_OK;
}

/// Every member is a number from 0 to `most`.
static hn_status check_numbers(const hn_rubric *r, const char *section, double most,
                               hn_diags *diags) {
    const cJSON *m, *node = hn_rubric_section(r, section);
    hn_status status = HN_OK;
    int entry = 0;
    cJSON_ArrayForEach(m, node) {
        entry++;
        if (!cJSON_IsNumber(m) || !(m->valuedouble >= 0 && m->valuedouble <= most)) {
            status = m->string ? hn_rubric_fault(r, diags, section, m->string, NULL,
                                                 "'%.40s' in \"%s\" needs a number from 0 to %g",
                                                 m->string, section, most)
                               : hn_rubric_fault(r, diags, section, NULL, NULL,
                                                 "entry %d of \"%s\" needs a number from 0 to %g",
                                                 entry, section, most);
        }
    }
    return status;
}

/// A relative tolerance that is allowed, as near as can be to the one that was given, in the
/// syntax of the file; NaN: half a per cent.
static void suggest_relative(const hn_rubric *r, double given, char hint[HN_DIAG_HINT]) {
    const double x = isnan(given) ? 0.005 : fmin(fmax(given, TIGHTEST), LOOSEST);
    snprintf(hint, HN_DIAG_HINT, r->toml ? "relative = %g" : "\"relative\": %g", x);
}

static hn_status check_tolerances(const hn_rubric *r, hn_diags *diags) {
    const cJSON *m, *x;
    char hint[HN_DIAG_HINT];
    hn_status status = HN_OK;
    cJSON_ArrayForEach(m, hn_rubric_section(r, "tolerance")) {
        cJSON_ArrayForEach(x, m) {
            const bool relative = strcmp(x->string, "relative") == 0;
            if (!relative && strcmp(x->string, "absolute") != 0) {
                status = hn_rubric_fault(r, diags, "tolerance", x->string, "relative, absolute",
                                         "a tolerance has no '%.40s'", x->string);
            } else if (!cJSON_IsNumber(x) || !(x->valuedouble >= 0)) {
                status = hn_rubric_fault(r, diags, "tolerance", m->string, NULL,
                                         "the %s tolerance of part %.20s needs a number from 0",
                                         x->string, m->string);
            } else if (relative && !(x->valuedouble >= TIGHTEST && x->valuedouble <= LOOSEST)) {
                suggest_relative(r, x->valuedouble, hint);
                status = hn_rubric_fault(
                    r, diags, "tolerance", m->string, hint,
                    "the relative tolerance %g of part %.20s is %s; %g to %g is allowed",
                    x->valuedouble, m->string,
                    x->valuedouble < TIGHTEST ? "tighter than that to which references are proved"
                                              : "too wide to tell mistakes apart",
                    TIGHTEST, LOOSEST);
            }
        }
    }
    return status;
}

/// The tolerance of each part is an object; any other is left out after its fault is added.
static hn_status check_tolerance_shapes(hn_rubric *r, hn_diags *diags) {
    cJSON *tolerance = cJSON_GetObjectItemCaseSensitive(r->root, "tolerance");
    hn_status status = HN_OK;
    for (cJSON *m = tolerance ? tolerance->child : NULL, *next; m; m = next) {
        next = m->next;
        if (!cJSON_IsObject(m)) {
            char relative[HN_DIAG_HINT], hint[HN_DIAG_HINT];
            suggest_relative(r, cJSON_IsNumber(m) ? m->valuedouble : (double)NAN, relative);
            snprintf(hint, sizeof hint, r->toml ? "%.20s = {%.60s}" : "\"%.20s\": {%.60s}",
                     m->string, relative);
            status = hn_rubric_fault(r, diags, "tolerance", m->string, hint,
                                     "the tolerance of part %.20s is %s", m->string,
                                     r->toml ? "a table" : "an object");
            cJSON_Delete(cJSON_DetachItemViaPointer(tolerance, m));
        }
    }
    return status;
}

/// Checks the shapes that the other checks rely on: objects with a member for each part or mistake,
/// lists of costs. A field of another shape is left out after its fault is added, so that the rest
/// is checked too.
static hn_status check_shapes(hn_rubric *r, hn_diags *diags) {
    static const struct {
        const char *field, *says, *json, *toml;
        bool list;
    } ROWS[] = {
        {"points", "with a number for each part", "{\"a\": 2}", "{a = 2}", false},
        {"tolerance", "with a member for each part", "{\"a\": {\"relative\": 0.005}}",
         "{a = {relative = 0.005}}", false},
        {"shares", "with a number for each mistake", "{\"sign\": 0.5}", "{sign = 0.5}", false},
        {"visibility", "with a word for each part", "{\"a\": \"hidden\"}", "{a = \"hidden\"}",
         false},
        {"hints", "with the cost of each hint", "[0.5, 1]", "[0.5, 1]", true}};
    hn_status status = HN_OK;
    if (!cJSON_IsObject(r->root)) {
        return hn_rubric_fault(r, diags, "", NULL, "holonom rubric write ID",
                               "a rubric is an object");
    }
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        const char *field = ROWS[i].field;
        const cJSON *node = hn_rubric_section(r, field);

        // more than one where the field is there twice
        for (; node && !(ROWS[i].list ? cJSON_IsArray(node) : cJSON_IsObject(node));
             node = hn_rubric_section(r, field)) {
            char hint[HN_DIAG_HINT];
            snprintf(hint, sizeof hint, r->toml ? "%s = %s" : "\"%s\": %s", field,
                     r->toml ? ROWS[i].toml : ROWS[i].json);
            status = hn_rubric_fault(r, diags, field, NULL, hint, "\"%s\" is %s %s", field,
                                     ROWS[i].list ? "a list"
                                     : r->toml    ? "a table"
                                                  : "an object",
                                     ROWS[i].says);
            cJSON_DeleteItemFromObjectCaseSensitive(r->root, field);
            if (strcmp(field, "points") == 0) {
                // a sum without these points would be another
                cJSON_DeleteItemFromObjectCaseSensitive(r->root, "total");
            }
        }
    }
    const hn_status inner = check_tolerance_shapes(r, diags);
    return status == HN_OK ? inner : status;
}

static hn_status check_fields(hn_rubric *r, hn_diags *diags) {
    const cJSON *m;
    hn_status status = check_shapes(r, diags);
    if (!cJSON_IsObject(r->root)) {
        return status;
    }
    cJSON_ArrayForEach(m, r->root) {
        int k = 0;
        while (k < N_FIELDS && strcmp(FIELDS[k], m->string) != 0) {
            k++;
        }
        if (k == N_FIELDS) {
            char hint[HN_DIAG_HINT];
            status =
                hn_rubric_fault(r, diags, m->string, NULL,
                                hn_suggest_or_list(hint, m->string, FIELDS, N_FIELDS, "fields: "),
                                "a rubric has no field '%.40s'", m->string);
        }
    }
    r->exercise = cJSON_GetStringValue(hn_rubric_section(r, "exercise"));
    if (hn_part_number(r->root, "rubric", 0) != 1 || !r->exercise) {
        return hn_rubric_fault(
            r, diags, "rubric", NULL, "holonom rubric write ID",
            r->toml ? "a rubric begins with rubric = 1 and the exercise that it is for"
                    : "a rubric begins with \"rubric\": 1 and the \"exercise\" that it is for");
    }
    const hn_status checked[] = {status,
                                 check_numbers(r, "points", 1e6, diags),
                                 check_numbers(r, "shares", 1, diags),
                                 check_numbers(r, "hints", 1e6, diags),
                                 check_tolerances(r, diags),
                                 check_visibilities(r, diags),
                                 check_once(r, diags)};
    for (size_t i = 0; i < sizeof checked / sizeof *checked; i++) {
        status = status == HN_OK ? checked[i] : status;
    }
    return status;
}

bool hn_rubric_is_toml(const char *path) {
    const char *ending = strrchr(path, '.');
    return ending && strcmp(ending, ".toml") == 0;
}

/// Puts JSON, on the same lines, in the place of TOML.
static hn_status translate(hn_rubric *r, hn_diag *diag) {
    hn_strbuf json;
    hn_strbuf_init(&json);
    const hn_status status = hn_toml_to_json(&json, hn_strbuf_text(&r->text), diag);
    if (status == HN_OK) {
        hn_strbuf_clear(&r->text);
        hn_strbuf_add_n(&r->text, hn_strbuf_text(&json), json.n);
    }
    hn_strbuf_reset(&json);
    return status;
}

hn_status hn_rubric_load_file(const char *path, hn_rubric **out, hn_diags *diags) {
    HN_ASSERT(path && out);
    hn_diag diag = {0};
    hn_rubric *r = calloc(1, sizeof *r);
    *out = NULL;
    if (!r) {
        return HN_ERR_MEMORY;
    }
    hn_strbuf_init(&r->text);
    const char *slash = strrchr(path, '/');
    snprintf(r->file, sizeof r->file, "%s", slash ? slash + 1 : path);
    r->toml = hn_rubric_is_toml(path);
    hn_status status = hn_file_load(path, MAX_BYTES, &r->text, diags);
    if (status == HN_OK) {
        r->hash = hn_hash_mix(hn_hash_bytes(HN_HASH_START, hn_strbuf_text(&r->text), r->text.n));
        status = r->toml ? translate(r, &diag) : HN_OK;
        const char *text = hn_strbuf_text(&r->text);
        HN_THEN(status, hn_json_text_check(text, r->text.n, MAX_DEPTH, &diag));
        if (status != HN_OK) {
            hn_diags_add(diags, status, "", diag.hint, "%s", diag.message);
        } else {
            r->root = cJSON_ParseWithLength(text, r->text.n);
            status = r->root ? check_fields(r, diags) : HN_ERR_MEMORY;
        }
    }
    // one with faulty fields can still be compared with its exercise
    if (status != HN_OK && !(status == HN_ERR_INPUT && r->exercise)) {
        hn_rubric_free(r);
        return status;
    }
    *out = r;
    return status;
}

void hn_rubric_free(hn_rubric *rubric) {
    if (rubric) {
        hn_strbuf_reset(&rubric->text);
        cJSON_Delete(rubric->root);
        free(rubric);
    }
}

const char *hn_rubric_exercise(const hn_rubric *r) {
    return r->exercise;
}

const char *hn_rubric_file(const hn_rubric *r) {
    return r ? r->file : "";
}

uint64_t hn_rubric_hash(const hn_rubric *r) {
    return r ? r->hash : 0;
}

double hn_rubric_share(const hn_rubric *r, const char *mistake, double otherwise) {
    return r ? hn_part_number(hn_rubric_section(r, "shares"), mistake, otherwise) : otherwise;
}

const char *hn_rubric_visibility(const hn_rubric *r, const char *entry) {
    const cJSON *m, *section = r ? hn_rubric_section(r, "visibility") : NULL;
    cJSON_ArrayForEach(m, section) {
        const size_t n = strlen(m->string);
        const char *behind = strncmp(entry, m->string, n) == 0 ? entry + n : "?";
        if (!*behind || *behind == '.' || isdigit((unsigned char)*behind)) {
            return m->valuestring;
        }
    }
    return "visible";
}

double hn_rubric_hints_cost(const hn_rubric *r, int n) {
    double cost = 0;
    for (int i = 0; r && i < n; i++) {
        const cJSON *m = cJSON_GetArrayItem(hn_rubric_section(r, "hints"), i);
        cost += cJSON_IsNumber(m) ? m->valuedouble : 0;
    }
    return cost;
}
