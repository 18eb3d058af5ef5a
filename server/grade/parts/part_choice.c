// SPDX-License-Identifier: GPL-3.0-or-later
// A choice among options, and the reason for it among reasons. The letters are dealt out anew for
// every seed. Half of the points are for the choice, half for the reason, which counts only beside
// the right choice: whoever guesses both gets full marks once in sixteen times.
#include "grade/parts/part_list.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MAX_OPTIONS = 10 };

/// The options, or the reasons, in the order of this part of this exercise with this seed.
static int deal(const hn_part *p, const char *key, const cJSON *order[MAX_OPTIONS]) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(p->node, key), *m;
    int n = 0;
    cJSON_ArrayForEach(m, list) {
        if (n < MAX_OPTIONS) {
            order[n++] = m;
        }
    }
    const int reasons = strcmp(key, "reasons") == 0;
    for (int i = n - 1; i > 0; i--) { // Fisher and Yates
        const uint64_t k = (uint64_t)(100 * (reasons + 1) + i);
        const int j = (int)(hn_draw_random(p->letters, k) * (i + 1));
        const cJSON *swap = order[i];
        order[i] = order[j];
        order[j] = swap;
    }
    return n;
}

static int find_right(const cJSON *const *order, int n) {
    int right = -1, count = 0;
    for (int i = 0; i < n; i++) {
        if (cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(order[i], "right"))) {
            right = i;
            count++;
        }
    }
    return count == 1 ? right : -1;
}

static void put_options(hn_strbuf *b, const hn_part *p, const char *key) {
    const cJSON *order[MAX_OPTIONS];
    const int n = deal(p, key, order);
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(b, "\n    (%c) ", 'a' + i);
        hn_draw_text(b, p->draw, hn_part_text(order[i], "text"));
    }
}

static int has_reasons(const hn_part *p) {
    return cJSON_GetObjectItemCaseSensitive(p->node, "reasons") != NULL;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    hn_strbuf_add(b, has_reasons(p) ? "{\"choice\": \"a\", \"reason\": \"b\"}; the reason counts "
                                      "beside the right choice"
                                    : "a letter: \"a\"");
    put_options(b, p, "options");
    if (has_reasons(p)) {
        hn_strbuf_add(b, "\n  because");
        put_options(b, p, "reasons");
    }
}

/// Letters of "b", "(B)." or "b, c", signs between them left out. Returns how many there are; -1
/// for words and for more than two.
static int split_letters(const char *text, char letters[2]) {
    static const char signs[] = " ().,;/";
    int n = 0;
    for (text += strspn(text, signs); *text; text += strspn(text, signs)) {
        if (n == 2 || strcspn(text, signs) != 1) {
            return -1;
        }
        letters[n++] = *text++;
    }
    return n;
}

/// The option that a letter names, -1 with the reason in `r`.
static int read_letter(const cJSON *node, int n, const char *what, hn_part_result *r) {
    const char *text = cJSON_GetStringValue(node);
    if (!node || cJSON_IsNull(node) || (text && !text[strspn(text, " \t\r\n")])) {
        hn_part_wrong(r, "blank", 0, "no %s was handed in%s", what,
                      strcmp(what, "reason") == 0 ? ": write {\"choice\": \"a\", \"reason\": \"b\"}"
                                                  : "");
        return -1;
    }

    char letters[2];
    const int i =
        text && split_letters(text, letters) == 1 ? tolower((unsigned char)letters[0]) - 'a' : -1;
    if (i < 0 || i >= n) {
        hn_part_unreadable(r, "the %s '%.60s' is not one letter from a to %c, in quotes: \"a\"",
                           what, r->given, 'a' + n - 1);
        return -1;
    }
    return i;
}

/// A member by its name, in capitals too.
static const cJSON *find_member(const cJSON *object, const char *name) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(object, name);
    return m ? m : cJSON_GetObjectItem(object, name);
}

/// "choice" and "reason" of an answer, owned: of an object, or of a list or text of two letters in
/// this order. Another text is the choice alone. NULL: no memory.
static cJSON *read_pair(const cJSON *given) {
    static const char *const names[] = {"choice", "reason"};
    const char *text = cJSON_GetStringValue(given);
    char letters[2];
    const bool two = text && split_letters(text, letters) == 2;
    const bool list = cJSON_IsArray(given) && cJSON_GetArraySize(given) == 2;
    cJSON *out = cJSON_CreateObject();
    for (int i = 0; i < 2 && out; i++) {
        const char letter[] = {two ? letters[i] : '\0', '\0'};
        cJSON *value = cJSON_IsObject(given) ? cJSON_Duplicate(find_member(given, names[i]), 1)
                       : list                ? cJSON_Duplicate(cJSON_GetArrayItem(given, i), 1)
                       : two                 ? cJSON_CreateString(letter)
                       : text && i == 0      ? cJSON_CreateString(text)
                                             : NULL;
        if (!cJSON_AddItemToObject(out, names[i], value)) {
            cJSON_Delete(value);
        }
    }
    return out;
}

/// The right option as the question prints it: "(b) its text".
static void write_expected(const hn_part *p, const cJSON *option, int letter, hn_part_result *r) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_strbuf_printf(&b, "(%c) ", 'a' + letter);
    hn_draw_text(&b, p->draw, hn_part_text(option, "text"));
    snprintf(r->expected, sizeof r->expected, "%s", hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}

/// Grades one of the two lists into one result.
static hn_status grade_list(const hn_part *p, const char *key, const cJSON *given,
                            hn_part_result *r, hn_diag *diag) {
    const cJSON *order[MAX_OPTIONS];
    const int n = deal(p, key, order), right = find_right(order, n);
    const int reasons = strcmp(key, "reasons") == 0;
    *r = (hn_part_result){.mistake = ""};
    snprintf(r->name, sizeof r->name, "%s", reasons ? "reason" : has_reasons(p) ? "choice" : "");
    if (right < 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/options", NULL,
                           "part %s: exactly one of the %s must be right", p->id, key);
    }
    write_expected(p, order[right], right, r);
    hn_part_keep_given(r, given);
    const int i = read_letter(given, n, reasons ? "reason" : "choice", r);
    if (i == right) {
        hn_part_right(r);
    } else if (i >= 0) {
        const char *id = hn_part_text(order[i], "fault");
        hn_part_wrong(r, id[0] ? id : "choice", 0, "%s", hn_part_text(order[i], "says"));
    }
    return HN_OK;
}

/// An answer from which neither choice nor reason can be taken.
static void refuse_form(const cJSON *given, hn_part_result *results) {
    for (int i = 0; i < 2; i++) {
        hn_part_keep_given(&results[i], given);
        hn_part_unreadable(&results[i],
                           "write choice and reason as {\"choice\": \"a\", \"reason\": \"b\"}");
    }
}

static hn_status grade_pair(const hn_part *p, const cJSON *given, hn_part_result *results,
                            hn_diag *diag) {
    cJSON *pair = read_pair(given);
    if (!pair) {
        return HN_ERR_MEMORY;
    }
    const cJSON *choice = cJSON_GetObjectItemCaseSensitive(pair, "choice");
    const cJSON *reason = cJSON_GetObjectItemCaseSensitive(pair, "reason");
    hn_status status = grade_list(p, "options", choice, &results[0], diag);
    HN_THEN(status, grade_list(p, "reasons", reason, &results[1], diag));
    if (status == HN_OK && given && !cJSON_IsNull(given) && !choice && !reason) {
        refuse_form(given, results);
    } else if (status == HN_OK && results[1].right && !results[0].right) {
        const bool chose = !results[0].unreadable && results[0].given[0];
        hn_part_wrong(&results[1], "unsupported", 0,
                      chose ? "this is true, and speaks for another choice than the one made"
                            : "this is true; it counts beside the right choice, and none was read");
    }
    cJSON_Delete(pair);
    return status;
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *results, int *n,
                       hn_diag *diag) {
    *n = has_reasons(p) ? 2 : 1;
    if (*n == 2) {
        return grade_pair(p, given, results, diag);
    }
    const cJSON *choice = cJSON_IsObject(given)            ? find_member(given, "choice")
                          : cJSON_GetArraySize(given) == 1 ? cJSON_GetArrayItem(given, 0)
                                                           : given;
    return grade_list(p, "options", choice ? choice : given, &results[0], diag);
}

static cJSON *write_letters(const hn_part *p, int choice, int reason) {
    char letter[2] = {(char)('a' + choice), 0}, other[2] = {(char)('a' + reason), 0};
    if (!has_reasons(p)) {
        return cJSON_CreateString(letter);
    }
    cJSON *out = cJSON_CreateObject();
    cJSON_AddStringToObject(out, "choice", letter);
    cJSON_AddStringToObject(out, "reason", other);
    return out;
}

static cJSON *blank(const hn_part *p) {
    if (!has_reasons(p)) {
        return cJSON_CreateString("");
    }
    cJSON *out = cJSON_CreateObject();
    cJSON_AddStringToObject(out, "choice", "");
    cJSON_AddStringToObject(out, "reason", "");
    return out;
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    const cJSON *order[MAX_OPTIONS], *reasons[MAX_OPTIONS];
    (void)diag;
    return write_letters(p, find_right(order, deal(p, "options", order)),
                         find_right(reasons, deal(p, "reasons", reasons)));
}

/// Each wrong option with the right reason, then the right option with each wrong reason.
static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    const cJSON *order[MAX_OPTIONS], *reasons[MAX_OPTIONS];
    const int n = deal(p, "options", order), m = deal(p, "reasons", reasons);
    (void)diag;
    if (i >= n + m) {
        return NULL;
    }
    const cJSON *wrong = i < n ? order[i] : reasons[i - n];
    const char *named = hn_part_text(wrong, "fault");
    *id = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(wrong, "right")) ? ""
          : named[0]                                                     ? named
                                                                         : "choice";
    return write_letters(p, i < n ? i : find_right(order, n),
                         i < n ? find_right(reasons, m) : i - n);
}

/// Every wrong option says why it is wrong.
static hn_status prove(const hn_part *p, hn_diag *diag) {
    static const char *const keys[] = {"options", "reasons"};
    for (int k = 0; k < 2; k++) {
        const cJSON *m;
        cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, keys[k])) {
            if (!cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(m, "right")) &&
                !hn_part_text(m, "says")[0]) {
                return hn_diag_set(diag, HN_ERR_INPUT, "/parts/options",
                                   "\"says\": \"why it is wrong\" beside its text",
                                   "part %s: the wrong option '%.80s' has no key 'says'", p->id,
                                   hn_part_text(m, "text"));
            }
        }
    }
    return HN_OK;
}

const hn_part_kind hn_part_choice = {
    .name = "choice",
    .fields = "options reasons",
    .ask = ask,
    .grade = grade,
    .blank = blank,
    .right = right,
    .fault = fault,
    .prove = prove,
};
