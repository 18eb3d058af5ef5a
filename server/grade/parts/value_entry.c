// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_entry.h"

#include "expr/construct.h"
#include "expr/diff.h"
#include "grade/parts/formula_frame.h"
#include "grade/parts/read_as.h"
#include "grade/parts/spelling.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARS = 2000 };

/// Returns whether a unit may begin at text[i]: behind a number, a bracket or a blank, never inside
/// a number (the unit "1/s" begins with a digit, and so does the end of "0.11/s").
static bool may_begin_unit(const char *text, size_t i) {
    const bool inside = strchr("0123456789.", text[i - 1]) && strchr("0123456789.", text[i]);
    return !inside && (strchr("0123456789.) ", text[i - 1]) || strncmp(text + i, "°", 2) == 0);
}

/// A formula with a unit behind it, as "2*pi rad/s": the unit is the longest end that is one.
static hn_status read_quantity(hn_value_sheet *s, const char *text, hn_ex *e, hn_unit *unit,
                               hn_diag *diag) {
    char head[MAX_CHARS];
    *unit = s->unit;
    hn_status status = hn_draw_parse_answer(s->draw, text, e, diag);
    const size_t n = strlen(text);
    for (size_t i = 1; status != HN_OK && i < n && n < MAX_CHARS; i++) {
        if (may_begin_unit(text, i)) {
            snprintf(head, sizeof head, "%.*s", (int)i, text);
            if (hn_unit_parse(text + i, unit) && text[i + strspn(text + i, " ")] &&
                hn_draw_parse_answer(s->draw, head, e, NULL) == HN_OK) {
                status = HN_OK;
            }
        }
    }
    return status;
}

/// Puts the sign of ASCII for a minus or dash that a word processor writes before a number.
static void plain_sign(char *number) {
    static const char *const MINUS[] = {"−", "–", "—", "‐", "‑"};
    for (size_t i = 0; i < sizeof MINUS / sizeof *MINUS; i++) {
        const size_t n = strlen(MINUS[i]);
        if (strncmp(number, MINUS[i], n) == 0) {
            number[0] = '-';
            memmove(number + 1, number + n, strlen(number + n) + 1);
            return;
        }
    }
}

/// Joins the groups of three digits that blanks part, as in "20 239"; the blanks may be no-break,
/// thin or narrow ones. Returns whether there were any.
static bool join_thousands(char *number) {
    const size_t length = strlen(number);
    static const char *const BLANKS[] = {" ", "\u00a0", "\u2009", "\u202f"};
    char *at = number + strspn(number, "+-");
    size_t digits = strspn(at, "0123456789");
    at += digits;
    for (size_t i = 0; i < sizeof BLANKS / sizeof *BLANKS && digits > 0 && digits <= 3;) {
        const size_t n = strlen(BLANKS[i]);
        const bool group = strncmp(at, BLANKS[i], n) == 0 && strspn(at + n, "0123456789") == 3;
        if (group) {
            memmove(at, at + n, strlen(at + n) + 1);
            at += 3;
        }
        i = group ? 0 : i + 1;
    }
    return strlen(number) < length;
}

/// Copies a number without what students write before it ("= ", "x = ", "≈ "), and with a point
/// for a decimal comma. A comma that may part thousands (1,234) stays: the number is refused.
/// Returns whether digits were joined, which the student is told.
static bool plain_number(const char *text, char *out, size_t size) {
    static const char *const about[] = {"≈", "~", "="};
    const char *equals = strrchr(text, '=');
    const char *at = equals ? equals + 1 : text;
    for (size_t i = 0; i < sizeof about / sizeof *about; i++) {
        at += strspn(at, " ");
        at += strncmp(at, about[i], strlen(about[i])) == 0 ? strlen(about[i]) : 0;
    }
    at += strspn(at, " ");
    snprintf(out, size, "%s", at);
    plain_sign(out);
    const bool joined = join_thousands(out);

    // one comma between digits, and no point
    char *comma = strchr(out, ',');
    if (!comma || comma == out || strpbrk(comma + 1, ",") || strchr(out, '.')) {
        return joined;
    }
    const size_t before = strspn(out, "+-0123456789"), after = strspn(comma + 1, "0123456789");
    const bool whole = out + before == comma && after > 0;
    const bool thousands = after == 3 && strspn(out, "+-0") < before;
    *comma = whole && !thousands ? '.' : ',';
    return joined;
}

/// 1 when a formula that should be a number has names in it.
static int uses_names(const hn_value_sheet *s, hn_ex e) {
    int uses = 0;
    for (int i = 0; i < s->draw->n_names; i++) {
        uses |= hn_depends_on(s->draw->graph, e, i);
    }
    return uses;
}

/// The reason why a formula cannot be read; of an unknown name without a near one, the known names.
static void refuse_formula(const hn_value_sheet *s, const char *text, const hn_diag *diag,
                           hn_part_result *r) {
    hn_strbuf hint;
    hn_strbuf_init(&hint);
    hn_strbuf_add(&hint, diag->hint);
    if (!diag->hint[0] && strstr(diag->message, "is not known here")) {
        hn_formula_put_known(&hint, s->draw->name, s->draw->n_names);
    }
    hn_part_unreadable(r, "'%.60s' cannot be read: %.180s%s%.150s", text, diag->message,
                       hint.n ? "; " : "", hn_strbuf_text(&hint));
    hn_strbuf_reset(&hint);
}

/// Returns whether the text begins with a number in digits that no double holds.
static bool is_beyond_largest(const char *text) {
    const char *digits = text + strspn(text, " +-.");
    return *digits >= '0' && *digits <= '9' && isinf(strtod(text, NULL));
}

/// The reason why a number cannot be read, with the slip that is most frequent.
static void refuse_number(const hn_value_sheet *s, const char *text, hn_part_result *r) {
    const char *unit = hn_part_text(s->p->node, "unit");
    char *end;
    strtod(text, &end);
    const char *tail = end + strspn(end, " ");
    if (is_beyond_largest(text)) {
        hn_part_unreadable(r, "'%.60s' is beyond the largest number, %.2g; write a smaller one",
                           text, DBL_MAX);
    } else if (end == text || !*tail) {
        hn_part_unreadable(r, "'%.60s' is no number; a number is asked for%s%s", text,
                           unit[0] ? ", if you like with its unit: 1.2 " : "", unit);
    } else if (*tail == ',') {
        hn_part_unreadable(r,
                           "'%.60s' has a comma at column %d, which may stand for decimals or "
                           "for thousands; write decimals with a point, and no comma elsewhere",
                           text, (int)(tail - text) + 1);
    } else {
        hn_part_unreadable(r, "'%.60s': '%.30s' at column %d is no unit known here; asked for: %s",
                           text, tail, (int)(tail - text) + 1, unit[0] ? unit : "a plain number");
    }
}

/// Returns whether two signs stand in a row, or one sign for a number with its uncertainty.
/// Arithmetic with them would be a guess at what is meant.
static bool has_two_signs(const char *text) {
    static const char *const SIGNS[] = {"+", "-", "−", "–"};
    static const char *const UNCERTAIN[] = {"±", "\\pm", "+/-", "+/−"};
    for (; *text; text++) {
        for (size_t i = 0; i < sizeof UNCERTAIN / sizeof *UNCERTAIN; i++) {
            if (strncmp(text, UNCERTAIN[i], strlen(UNCERTAIN[i])) == 0) {
                return true;
            }
        }

        // a sign directly behind a sign
        for (size_t i = 0; i < sizeof SIGNS / sizeof *SIGNS; i++) {
            const size_t n = strlen(SIGNS[i]);
            for (size_t k = 0; k < sizeof SIGNS / sizeof *SIGNS; k++) {
                if (strncmp(text, SIGNS[i], n) == 0 &&
                    strncmp(text + n, SIGNS[k], strlen(SIGNS[k])) == 0) {
                    return true;
                }
            }
        }
    }
    return false;
}

static const char *find_name(void *draw, const char *name) {
    return hn_draw_answer_name(draw, name);
}

/// A formula as the student wrote it, and in r->read_as how it was read.
static hn_status read_formula(hn_value_sheet *s, const char *text, hn_ex *e, hn_part_result *r,
                              hn_diag *diag) {
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_status status = hn_spelling_normalise(&plain, hn_formula_behind_name(text), diag);
    if (status == HN_OK) {
        status = hn_draw_parse_answer(s->draw, hn_strbuf_text(&plain), e, diag);
        hn_read_as(text, hn_strbuf_text(&plain), find_name, s->draw, r->read_as, sizeof r->read_as);
    }
    hn_strbuf_reset(&plain);
    return status;
}

/// The formula before the unit with which the text ends.
static hn_status read_before_unit(hn_value_sheet *s, const char *text, hn_ex *e,
                                  hn_part_result *r) {
    char head[MAX_CHARS];
    for (size_t at = 0; strlen(text) < MAX_CHARS && hn_formula_find_unit(text, &at);) {
        snprintf(head, sizeof head, "%.*s", (int)at, text);
        if (read_formula(s, head, e, r, NULL) == HN_OK) {
            snprintf(r->read_as, sizeof r->read_as, "%s", hn_formula_behind_name(head));
            for (size_t n = strlen(r->read_as); n > 0 && r->read_as[n - 1] == ' ';) {
                r->read_as[--n] = 0;
            }
            return HN_OK;
        }
    }
    return HN_ERR_INPUT;
}

bool hn_value_entry_read_before_unit(hn_value_sheet *s, const cJSON *node, double x[HN_DRAW_STATES],
                                     hn_ex *e, hn_part_result *r) {
    const char *text = cJSON_GetStringValue(node);
    if (!s->symbolic || !text || read_before_unit(s, text, e, r) != HN_OK) {
        return false;
    }
    for (int i = 0; i < s->draw->n_states; i++) {
        x[i] = hn_draw_eval(s->draw, *e, i);
    }
    return true;
}

/// Reads text as the student wrote it; 0 after it has said why it cannot be read.
static int read_text(hn_value_sheet *s, const char *text, hn_ex *e, hn_unit *unit,
                     hn_part_result *r) {
    hn_diag diag = {0};
    hn_strbuf plain;
    if (!s->symbolic && has_two_signs(text)) {
        hn_part_unreadable(r,
                           "'%.60s' has two signs in a row, or a sign for both; write one number "
                           "with one sign, without its uncertainty",
                           text);
        return 0;
    }
    hn_strbuf_init(&plain);
    hn_status status = HN_ERR_INPUT;

    // a number with its unit, as it stands or in the parser's own spelling; or a formula
    char number[MAX_CHARS];
    const char *own = text;
    bool joined = false;
    if (!s->symbolic && strlen(text) < MAX_CHARS) {
        joined = plain_number(text, number, sizeof number);
        own = number;
        status = read_quantity(s, own, e, unit, &diag);
    }
    if (s->symbolic) {
        status = read_formula(s, text, e, r, &diag);
        if (status == HN_ERR_INPUT && read_before_unit(s, text, e, r) == HN_OK) {
            status = HN_OK;
        }
    } else if (status != HN_OK) {
        status = hn_spelling_normalise(&plain, own, &diag);
        HN_THEN(status, read_quantity(s, hn_strbuf_text(&plain), e, unit, &diag));
    }
    const char *read = plain.n > 0 ? hn_strbuf_text(&plain) : own;
    const bool changed = !s->symbolic && (joined || strchr(text, ',')) && strcmp(read, text) != 0;
    if (status == HN_OK && changed) {
        snprintf(r->read_as, sizeof r->read_as, "%.*s", HN_PART_READ_AS - 1, read);
    }
    if (status != HN_OK && s->symbolic) {
        r->read_as[0] = 0;
        refuse_formula(s, text, &diag, r);
    } else if (status != HN_OK) {
        refuse_number(s, text, r);
    }
    hn_strbuf_reset(&plain);
    return status == HN_OK;
}

bool hn_value_entry_read(hn_value_sheet *s, const cJSON *node, double x[HN_DRAW_STATES], hn_ex *e,
                         hn_part_result *r) {
    hn_unit unit = s->unit;
    *e = hn_num(0);
    hn_part_keep_given(r, node);
    if (!node || cJSON_IsNull(node) || (cJSON_IsString(node) && !*node->valuestring)) {
        hn_part_wrong(r, "blank", 0, "nothing was handed in here");
        return false;
    }
    if (cJSON_IsNumber(node) && !isfinite(node->valuedouble)) {
        hn_part_unreadable(r, "this number is not finite");
        return false;
    }
    if (cJSON_IsNumber(node)) {
        *e = hn_num(node->valuedouble);
    } else if (!cJSON_IsString(node)) {
        hn_part_unreadable(r, "this is %s; write %s",
                           cJSON_IsObject(node)  ? "an object"
                           : cJSON_IsArray(node) ? "a list"
                                                 : "true or false",
                           s->symbolic ? "a formula in quotes" : "a number: 1.2 or \"1.2 m\"");
        return false;
    } else if (!read_text(s, node->valuestring, e, &unit, r)) {
        return false;
    }
    if (!s->symbolic && uses_names(s, *e)) {
        hn_part_unreadable(r, "a number is asked for, not a formula");
        return false;
    }
    const bool angle = unit.power[HN_UNIT_ANGLE] != 0;
    if (!hn_unit_fits(&unit, &s->unit) || (angle && hn_value_is_count(s))) {
        const char *own = hn_part_text(s->p->node, "unit");
        hn_part_wrong(r, "unit", 0, "this unit measures something else; asked for: %s",
                      own[0] ? own : "a plain number, without a unit");
        return false;
    }

    // in the unit that is asked for
    const double ratio = hn_unit_ratio(&unit, &s->unit);
    for (int i = 0; i < s->draw->n_states; i++) {
        x[i] = hn_draw_eval(s->draw, *e, i) * ratio;
    }
    *e = hn_scale(ratio, *e);
    return true;
}
