// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/list_text.h"

#include "grade/parts/span.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 3, MOST_ENTRIES = 4096 };

static bool is_opening(char c) {
    return c == '[' || c == '(' || c == '{';
}

static bool is_closing(char c) {
    return c == ']' || c == ')' || c == '}';
}

static bool is_list(hn_span s) {
    return s.at < s.end && (*s.at == '[' || *s.at == '{');
}

/// The bracket that closes the one at s.at; NULL: none.
static const char *find_closing(hn_span s) {
    int depth = 0;
    for (const char *c = s.at; c < s.end; c++) {
        depth += is_opening(*c) - is_closing(*c);
        if (depth == 0) {
            return c;
        }
    }
    return NULL;
}

// ---- what stands around a list ----

/// Leaves "J =" before a list away, and the semicolon behind it.
static hn_span strip_assignment(hn_span s) {
    const char *c = s.at;
    while (c < s.end && (isalnum((unsigned char)*c) || *c == '_')) {
        c++;
    }
    const char *name_end = c;
    while (c < s.end && *c == ' ') {
        c++;
    }
    if (name_end > s.at && c < s.end && *c == '=') {
        s.at = c + 1;
    }
    if (s.end > s.at && s.end[-1] == ';') {
        s.end--;
    }
    return hn_span_trim(s);
}

/// Leaves the call that makes a matrix of a list away: np.array([...], dtype=float).
static hn_span strip_call(hn_span s) {
    static const char *const MAKERS[] = {"np.array(",     "numpy.array(", "np.matrix(",
                                         "numpy.matrix(", "array(",       "matrix(",
                                         "sympy.Matrix(", "sp.Matrix(",   "Matrix("};
    for (size_t i = 0; i < sizeof MAKERS / sizeof *MAKERS; i++) {
        const size_t n = strlen(MAKERS[i]);
        if ((size_t)(s.end - s.at) > n && strncmp(s.at, MAKERS[i], n) == 0 && s.end[-1] == ')') {
            const hn_span inside = hn_span_trim((hn_span){s.at + n, s.end - 1});
            const char *close = is_list(inside) ? find_closing(inside) : NULL;
            const hn_span rest = close ? hn_span_trim((hn_span){close + 1, inside.end}) : inside;
            const bool whole = close && (rest.at == rest.end || *rest.at == ',');
            return whole ? (hn_span){inside.at, close + 1} : s;
        }
    }
    return s;
}

// ---- entries of a row ----

/// Returns whether a sign that makes an operator, so that blanks about it part nothing.
static bool is_operator(char c) {
    return c != '\0' && strchr("+-*/^=@", c) != NULL;
}

/// Returns whether blanks part two entries: "a -b" does, "a - b" and "a * b" do not.
static bool blanks_part(const char *before, const char *after, hn_span s) {
    if (before <= s.at || after >= s.end || is_operator(before[-1])) {
        return false;
    }
    const char second = after + 1 < s.end ? after[1] : '\0';
    const bool sign = *after == '+' || *after == '-',
               entrywise = *after == '.' && is_operator(second);
    return sign ? !isspace((unsigned char)second) : !is_operator(*after) && !entrywise;
}

/// The end of the first piece of `s`: at a mark outside all brackets, or with mark ' ' at blanks
/// that part entries. *next is where the rest begins.
static const char *find_end(hn_span s, char mark, const char **next) {
    int depth = 0;
    for (const char *c = s.at; c < s.end; c++) {
        depth += is_opening(*c) - is_closing(*c);
        if (depth != 0) {
            continue;
        }
        if (*c == mark && mark != ' ') {
            *next = c + 1;
            return c;
        }
        if (mark == ' ' && isspace((unsigned char)*c)) {
            const char *after = c;
            while (after < s.end && isspace((unsigned char)*after)) {
                after++;
            }
            if (blanks_part(c, after, s)) {
                *next = after;
                return c;
            }
            c = after - 1;
        }
    }
    *next = s.end;
    return s.end;
}

static bool holds(hn_span s, char mark) {
    const char *next;
    return find_end(s, mark, &next) < s.end;
}

static cJSON *make_entry(hn_span s) {
    s = hn_span_trim(s);
    char *text = strndup(s.at, (size_t)(s.end - s.at)), *end = NULL;
    const double number = text ? strtod(text, &end) : 0;
    const bool is_number =
        text && end > text && !*end && strspn(text, "+-.0123456789eE") == strlen(text);
    cJSON *out = is_number ? cJSON_CreateNumber(number) : text ? cJSON_CreateString(text) : NULL;
    free(text);
    return out;
}

static cJSON *read_list(hn_span s, int depth);

/// One piece of a list: a list itself, a row between semicolons, or an entry.
static cJSON *read_piece(hn_span s, char mark, int depth) {
    s = hn_span_trim(s);
    if (is_list(s) && find_closing(s) == s.end - 1 && depth < DEEPEST) {
        return read_list((hn_span){s.at + 1, s.end - 1}, depth + 1);
    }
    return mark == ';' || mark == '\n' ? read_list(s, depth + 1) : make_entry(s);
}

/// Reads what stands between the brackets of a list. An empty piece between two marks is the empty
/// text: it keeps its place, and hn_list_text_expand() counts it. NULL: too many entries, or no
/// memory.
static cJSON *read_list(hn_span s, int depth) {
    s = hn_span_trim(s);
    const char mark = holds(s, ';') ? ';' : holds(s, ',') ? ',' : holds(s, '\n') ? '\n' : ' ';
    cJSON *out = cJSON_CreateArray();
    int n = 0;
    while (out && s.at < s.end) {
        const char *next;
        // rows on lines of their own may be lists: [[1 2]\n [3 4]]
        const hn_span piece = {s.at, find_end(s, mark, &next)};
        cJSON *entry = n++ < MOST_ENTRIES ? read_piece(piece, mark, depth) : NULL;
        if (!entry || !cJSON_AddItemToArray(out, entry)) {
            cJSON_Delete(entry);
            cJSON_Delete(out);
            return NULL;
        }
        s.at = next;
        s = mark == ';' ? hn_span_trim(s) : s;
    }
    return out;
}

/// Returns whether a list has more than one entry, or rows: "[a + b]" is a formula in brackets.
static bool is_several(const cJSON *list) {
    return cJSON_GetArraySize(list) > 1 || cJSON_IsArray(list ? list->child : NULL);
}

// ---- LaTeX ----

/// Finds what stands in the matrix of LaTeX that is the whole of `s`; false: there is none.
static bool find_latex(hn_span s, hn_span *inside) {
    static const char BEGIN[] = "\\begin{", END[] = "\\end{";
    const char *open = (size_t)(s.end - s.at) > strlen(BEGIN) ? strstr(s.at, BEGIN) : NULL;
    const char *name_end = open == s.at ? strchr(s.at, '}') : NULL;
    const char *close = name_end ? strstr(name_end, END) : NULL;
    const size_t n = name_end ? (size_t)(name_end - s.at) - strlen(BEGIN) : 0;
    const bool matrix = n >= 6 && strncmp(name_end - 6, "matrix", 6) == 0;
    if (!matrix || !close || strncmp(close + strlen(END), name_end - n, n) != 0 ||
        close + strlen(END) + n + 1 != s.end) {
        return false;
    }
    *inside = hn_span_trim((hn_span){name_end + 1, close});
    return true;
}

/// The end of a row: two backslashes, or the one before a blank that JSON made of them.
static const char *find_row_end(hn_span s, const char **next) {
    for (const char *c = s.at; c < s.end; c++) {
        const bool two = c[0] == '\\' && c + 1 < s.end && c[1] == '\\';
        if (two || (c[0] == '\\' && c + 1 < s.end && isspace((unsigned char)c[1]))) {
            *next = c + (two ? 2 : 1);
            return c;
        }
    }
    *next = s.end;
    return s.end;
}

/// The rows between the two ends of the matrix, parted by & into entries.
static cJSON *read_latex(hn_span s) {
    cJSON *out = cJSON_CreateArray();
    int n = 0;
    while (out && s.at < s.end && n < MOST_ENTRIES) {
        const char *next, *after;
        hn_span row = {s.at, find_row_end(s, &next)};
        cJSON *list = cJSON_CreateArray();
        cJSON_AddItemToArray(out, list);
        do {
            const hn_span entry = {row.at, find_end(row, '&', &after)};
            cJSON_AddItemToArray(list, make_entry(entry));
            row.at = after;
        } while (row.at < row.end && n++ < MOST_ENTRIES);
        s = hn_span_trim((hn_span){next, s.end});
    }
    return out;
}

cJSON *hn_list_text_read(const char *text) {
    hn_span inside;
    if (find_latex(strip_assignment(hn_span_trim((hn_span){text, text + strlen(text)})), &inside)) {
        return read_latex(inside);
    }
    hn_span s = strip_call(strip_assignment(hn_span_trim((hn_span){text, text + strlen(text)})));
    if (!is_list(s) || find_closing(s) != s.end - 1) {
        return NULL;
    }
    cJSON *list = read_list((hn_span){s.at + 1, s.end - 1}, 1);
    if (!is_several(list)) {
        cJSON_Delete(list);
        return NULL;
    }
    return list;
}

/// Returns how many entries of a list, and of the lists in it, are the empty text.
static int count_empty(const cJSON *list) {
    int n = 0;
    const cJSON *m;
    cJSON_ArrayForEach(m, list) {
        n += cJSON_IsArray(m) ? count_empty(m) : cJSON_IsString(m) && !m->valuestring[0];
    }
    return n;
}

/// Replaces the texts among the members of an object; those of its objects too.
static int expand(cJSON *object, int depth, char *name, int size, int *n_empty) {
    static const char *const OTHERS[] = {"student", "comment", "problem", "exercise", "seed"};
    int n = 0;
    for (cJSON *m = object->child, *next; m; m = next) {
        bool other = false;
        next = m->next;
        for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
            other |= depth == 0 && strcmp(m->string, OTHERS[i]) == 0;
        }
        cJSON *list = cJSON_IsString(m) && !other ? hn_list_text_read(m->valuestring) : NULL;
        if (list) {
            if (!name[0]) {
                snprintf(name, (size_t)size, "%s", m->string);
            }
            *n_empty += count_empty(list);
            char *key = strdup(m->string);
            if (key && cJSON_ReplaceItemInObjectCaseSensitive(object, key, list)) {
                n++;
            } else {
                cJSON_Delete(list);
            }
            free(key);
        } else if (cJSON_IsObject(m) && depth == 0) {
            n += expand(m, depth + 1, name, size, n_empty);
        }
    }
    return n;
}

int hn_list_text_expand(cJSON *submission, char *name, int size, int *n_empty) {
    name[0] = '\0';
    *n_empty = 0;
    return cJSON_IsObject(submission) ? expand(submission, 0, name, size, n_empty) : 0;
}
