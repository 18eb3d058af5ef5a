// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/comma_list.h"

#include "grade/parts/span.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/// Leaves the pair of brackets around the whole text away.
static hn_span strip_brackets(hn_span s) {
    static const char OPEN[] = "[({", CLOSE[] = "])}";
    const char *open = s.at < s.end ? strchr(OPEN, *s.at) : NULL;
    if (open && s.end - s.at > 1 && s.end[-1] == CLOSE[open - OPEN]) {
        s = (hn_span){s.at + 1, s.end - 1};
    }
    return hn_span_trim(s);
}

static bool is_decimal(hn_span s, const char *comma) {
    return comma > s.at && comma + 1 < s.end && isdigit((unsigned char)comma[-1]) &&
           isdigit((unsigned char)comma[1]);
}

/// Counts the commas of an entry that begins like a number; -1 when it cannot be one.
static int count_commas(hn_span s) {
    int n = 0;
    const char *first = s.at + strspn(s.at, "+-");
    if (first >= s.end || !(isdigit((unsigned char)*first) || (unsigned char)*first >= 0x80)) {
        return -1;
    }
    for (const char *c = s.at; c < s.end; c++) {
        if (strchr("[](){};", *c) || (*c == ',' && (++n > 1 || !is_decimal(s, c)))) {
            return -1;
        }
    }
    return n;
}

/// The end of the first entry: at a mark, or with mark ' ' at a blank before a number.
static const char *find_end(hn_span s, char mark) {
    for (const char *c = s.at; c < s.end; c++) {
        const char next = c + 1 < s.end ? c[1] : '\0';
        const bool number = isdigit((unsigned char)next) || next == '-' || next == '+';
        if (*c == mark && (mark != ' ' || number)) {
            return c;
        }
    }
    return s.end;
}

/// The entries between the marks; NULL: there are not n of them, or none has a comma.
static cJSON *read_entries(hn_span s, char mark, int n) {
    cJSON *out = cJSON_CreateArray();
    int commas = 0;
    bool good = out != NULL;
    while (good && s.at < s.end && cJSON_GetArraySize(out) < n) {
        const char *end = find_end(s, mark);
        const hn_span entry = hn_span_trim((hn_span){s.at, end});
        const int own = count_commas(entry);
        char *text = strndup(entry.at, (size_t)(entry.end - entry.at));
        good = own >= 0 && text && cJSON_AddItemToArray(out, cJSON_CreateString(text));
        commas += own;
        free(text);
        s = hn_span_trim((hn_span){end < s.end ? end + 1 : end, s.end});
    }
    if (!good || s.at < s.end || commas == 0 || cJSON_GetArraySize(out) != n) {
        cJSON_Delete(out);
        return NULL;
    }
    return out;
}

cJSON *hn_comma_list_read(const char *text, int n) {
    static const char MARKS[] = ";\n ";
    const hn_span s = strip_brackets(hn_span_trim((hn_span){text, text + strlen(text)}));
    cJSON *out = NULL;
    for (const char *mark = MARKS; *mark && !out && n > 1; mark++) {
        out = read_entries(s, *mark, n);
    }
    return out;
}

bool hn_comma_list_is_unclear(const char *text) {
    const hn_span s = {text, text + strlen(text)};
    for (const char *c = text; (c = strchr(c, ',')) != NULL; c++) {
        if (is_decimal(s, c)) {
            return true;
        }
    }
    return false;
}
