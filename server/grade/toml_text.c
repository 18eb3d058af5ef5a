// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/toml_text.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NAME = 80, MAX_NESTING = 8 };

typedef struct reader {
    const char *at;
    hn_strbuf *out;
    int line;
    char table[MAX_NESTING][MAX_NAME]; ///< names of the tables that are open
    int n_tables;
    bool comma; ///< the next member of the object that is open needs one before it
    hn_diag *diag;
} reader;

// ---- reading ----

static hn_status fault(const reader *r, const char *what) {
    return hn_diag_set(r->diag, HN_ERR_INPUT, NULL, "a line of TOML is: name = value",
                       "line %d: %s", r->line, what);
}

/// Steps over blanks, and over comments and ends of lines where `lines` is set; ends of lines are
/// copied.
static void skip(reader *r, bool lines) {
    for (;;) {
        r->at += strspn(r->at, " \t\r");
        if (*r->at == '#') {
            r->at += strcspn(r->at, "\n");
        }
        if (*r->at != '\n' || !lines) {
            return;
        }
        hn_strbuf_add(r->out, "\n");
        r->line++;
        r->at++;
    }
}

/// The end of the line: nothing but a comment may stand before it.
static hn_status end_line(reader *r) {
    skip(r, false);
    return *r->at && *r->at != '\n' ? fault(r, "something stands behind the value") : HN_OK;
}

/// Copies text in quotes to `out` as JSON, without quotes: "with escapes", 'as it stands'.
static hn_status copy_quoted(reader *r, hn_strbuf *out) {
    const char quote = *r->at++;
    while (*r->at && *r->at != quote && *r->at != '\n') {
        const bool escape = *r->at == '\\' && quote == '"' && r->at[1] && r->at[1] != '\n';
        if (quote == '\'' && strchr("\\\"", *r->at)) {
            hn_strbuf_add(out, "\\");
        }
        if (*r->at == '\t') {
            hn_strbuf_add(out, "\\t"); // JSON has no tabs in texts
            r->at++;
            continue;
        }
        hn_strbuf_add_n(out, r->at, escape ? 2 : 1);
        r->at += escape ? 2 : 1;
    }
    if (*r->at != quote) {
        return fault(r, "a text has no end on its line");
    }
    r->at++;
    return HN_OK;
}

static hn_status copy_text(reader *r) {
    hn_strbuf_add(r->out, "\"");
    HN_TRY(copy_quoted(r, r->out));
    hn_strbuf_add(r->out, "\"");
    return HN_OK;
}

/// Keeps a name, as JSON has it between its quotes.
static hn_status keep_name(reader *r, const char *text, size_t n, char name[MAX_NAME]) {
    if (n >= MAX_NAME - 1) {
        return fault(r, "a name is longer than 78 bytes");
    }
    memcpy(name, text, n);
    name[n] = 0;
    skip(r, false);
    return HN_OK;
}

/// A name: letters, digits, _ and -, or in quotes.
static hn_status read_name(reader *r, char name[MAX_NAME]) {
    if (*r->at == '"' || *r->at == '\'') {
        hn_strbuf text;
        hn_strbuf_init(&text);
        hn_status status = copy_quoted(r, &text);
        status = status == HN_OK && text.failed ? HN_ERR_MEMORY : status;
        HN_THEN(status, keep_name(r, hn_strbuf_text(&text), text.n, name));
        hn_strbuf_reset(&text);
        return status;
    }
    const char *start = r->at;
    while (isalnum((unsigned char)*r->at) || *r->at == '_' || *r->at == '-') {
        r->at++;
    }
    return r->at == start ? fault(r, "a name was expected")
                          : keep_name(r, start, (size_t)(r->at - start), name);
}

/// Opens a member of the object that is open.
static void put_name(reader *r, const char *name) {
    hn_strbuf_printf(r->out, "%s\"%s\": ", r->comma ? ", " : "", name);
    r->comma = true;
}

static hn_status copy_value(reader *r, int nesting);

/// name = value
static hn_status copy_member(reader *r, int nesting) {
    char name[MAX_NAME];
    HN_TRY(read_name(r, name));
    if (*r->at != '=') {
        return fault(r, *r->at == '.'
                            ? "a name with a point is not read here: write [a], then b = 1"
                            : "'=' was expected behind the name");
    }
    r->at++;
    put_name(r, name);
    return copy_value(r, nesting);
}

/// A list, which may take several lines, or an inline table, which may not.
static hn_status copy_members(reader *r, int nesting) {
    const bool list = *r->at++ == '[';
    const char close = list ? ']' : '}';
    const bool outer = r->comma;
    r->comma = false;
    hn_strbuf_add(r->out, list ? "[" : "{");
    for (skip(r, list); *r->at != close; skip(r, list)) {
        if (list && r->comma) {
            hn_strbuf_add(r->out, ", ");
        }
        HN_TRY(list ? copy_value(r, nesting) : copy_member(r, nesting));
        r->comma = true;
        skip(r, list);
        if (*r->at != ',' && *r->at != close) {
            return fault(r, list ? "',' or ']' was expected" : "',' or '}' was expected");
        }
        r->at += *r->at == ',';
    }
    r->at++;
    r->comma = outer;
    hn_strbuf_add(r->out, list ? "]" : "}");
    return HN_OK;
}

static hn_status copy_number(reader *r) {
    const size_t n = strcspn(r->at, " \t\r\n#,]}");
    char word[40], *end;
    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : sizeof word - 1), r->at);
    const double x = strtod(word, &end);
    const bool digits = strspn(word, "+-.eE0123456789") == n; // false for one that was cut
    const bool truth = strcmp(word, "true") == 0 || strcmp(word, "false") == 0;
    if (truth) {
        hn_strbuf_add(r->out, word);
    } else if (n == 0 || *end || !digits || !isfinite(x)) {
        return fault(r, "a number, a text in quotes, true, false, [...] or {...} was expected");
    } else {
        hn_strbuf_printf(r->out, "%.17g", x);
    }
    r->at += n;
    return HN_OK;
}

static hn_status copy_value(reader *r, int nesting) {
    if (nesting == MAX_NESTING) {
        return fault(r, "too many brackets within each other");
    }
    skip(r, false);
    if (*r->at == '"' || *r->at == '\'') {
        return copy_text(r);
    }
    return *r->at == '[' || *r->at == '{' ? copy_members(r, nesting + 1) : copy_number(r);
}

// ---- tables ----

static void close_tables(reader *r, int keep) {
    for (; r->n_tables > keep; r->n_tables--) {
        hn_strbuf_add(r->out, "}");
        r->comma = true;
    }
}

/// [a.b]: closes the tables that are not part of it, and opens those that are missing.
static hn_status open_table(reader *r) {
    char name[MAX_NAME];
    int depth = 0;
    bool shared = true, more = true;
    if (*++r->at == '[') {
        return fault(r, "a list of tables, [[name]], is not read here: write name = [{...}]");
    }
    for (; more; depth++) {
        skip(r, false);
        HN_TRY(read_name(r, name));
        if (depth == MAX_NESTING || (*r->at != '.' && *r->at != ']')) {
            return fault(r, "a table is [name] or [name.name]");
        }
        more = *r->at++ == '.';
        shared = shared && depth < r->n_tables && strcmp(r->table[depth], name) == 0;
        if (!shared) {
            close_tables(r, depth);
            put_name(r, name);
            hn_strbuf_add(r->out, "{");
            r->comma = false;
            snprintf(r->table[r->n_tables++], MAX_NAME, "%s", name);
        }
    }
    close_tables(r, depth);
    return HN_OK;
}

hn_status hn_toml_to_json(hn_strbuf *out, const char *text, hn_diag *diag) {
    reader r = {.at = text, .out = out, .line = 1, .diag = diag};
    hn_strbuf_add(out, "{");
    for (skip(&r, true); *r.at; skip(&r, true)) {
        HN_TRY(*r.at == '[' ? open_table(&r) : copy_member(&r, 0));
        HN_TRY(end_line(&r));
    }
    close_tables(&r, 0);
    hn_strbuf_add(out, "}");
    return out->failed ? HN_ERR_MEMORY : HN_OK;
}

// ---- writing ----

static void put_value(hn_strbuf *out, const cJSON *value);

/// Numbers and texts of JSON are those of TOML.
static void put_scalar(hn_strbuf *out, const cJSON *value) {
    char *text = cJSON_PrintUnformatted(value);
    hn_strbuf_add(out, text ? text : "");
    out->failed |= !text;
    cJSON_free(text);
}

/// A name as it stands where TOML allows it, else in quotes.
static void put_key(hn_strbuf *out, const char *name) {
    bool bare = name[0] != 0;
    for (const char *at = name; *at; at++) {
        bare &= isalnum((unsigned char)*at) || *at == '_' || *at == '-';
    }
    if (bare) {
        hn_strbuf_add(out, name);
        return;
    }
    cJSON *text = cJSON_CreateStringReference(name);
    put_scalar(out, text);
    cJSON_Delete(text);
}

static void put_members(hn_strbuf *out, const cJSON *value) {
    const cJSON *m;
    const bool list = cJSON_IsArray(value);
    hn_strbuf_add(out, list ? "[" : "{");
    cJSON_ArrayForEach(m, value) {
        hn_strbuf_add(out, m == value->child ? "" : ", ");
        if (!list) {
            put_key(out, m->string);
            hn_strbuf_add(out, " = ");
        }
        put_value(out, m);
    }
    hn_strbuf_add(out, list ? "]" : "}");
}

static void put_value(hn_strbuf *out, const cJSON *value) {
    if (cJSON_IsArray(value) || cJSON_IsObject(value)) {
        put_members(out, value);
    } else {
        put_scalar(out, value);
    }
}

static void put_lines(hn_strbuf *out, const cJSON *object, bool tables) {
    const cJSON *m;
    cJSON_ArrayForEach(m, object) {
        if (tables || !cJSON_IsObject(m)) {
            put_key(out, m->string);
            hn_strbuf_add(out, " = ");
            put_value(out, m);
            hn_strbuf_add(out, "\n");
        }
    }
}

void hn_toml_write(hn_strbuf *out, const cJSON *object) {
    const cJSON *m;
    put_lines(out, object, false);
    cJSON_ArrayForEach(m, object) {
        if (cJSON_IsObject(m)) {
            hn_strbuf_add(out, "\n[");
            put_key(out, m->string);
            hn_strbuf_add(out, "]\n");
            put_lines(out, m, true);
        }
    }
}
