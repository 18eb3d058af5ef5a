// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_sheet.h"

#include <math.h>
#include <string.h>

enum { STATES = 12 };

int hn_value_is_symbolic(const hn_part *p) {
    return strncmp(hn_part_text(p->node, "kind"), "formula", 7) == 0;
}

int hn_value_flatten(const cJSON *node, const cJSON *list[HN_VALUE_ENTRIES], int *columns) {
    int n = 0;
    const cJSON *row, *entry;
    *columns = 0;

    // one entry
    if (!cJSON_IsArray(node)) {
        list[0] = node;
        return 1;
    }

    // a list; its entries may be rows
    cJSON_ArrayForEach(row, node) {
        if (!cJSON_IsArray(row)) {
            if (n == HN_VALUE_ENTRIES) {
                return -1;
            }
            list[n++] = row;
            continue;
        }

        // a row: its entries, one after another
        *columns = cJSON_GetArraySize(row);
        cJSON_ArrayForEach(entry, row) {
            if (n == HN_VALUE_ENTRIES) {
                return -1;
            }
            list[n++] = entry;
        }
    }
    return n;
}

hn_status hn_value_read(hn_value_sheet *s, const cJSON *node, const hn_values *base,
                        hn_values *out) {
    const cJSON *list[HN_VALUE_ENTRIES];

    // as many entries as the base
    out->n = hn_value_flatten(node, list, &out->columns);
    if (out->n < 1 || (base && out->n != base->n)) {
        return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                           "part %s: the answer needs 1 to %d entries, the same in every fault",
                           s->p->id, HN_VALUE_ENTRIES);
    }

    // only null may stand for no formula, and only over a base
    for (int k = 0; k < out->n; k++) {
        const char *text = cJSON_GetStringValue(list[k]);
        if (!text && !(base && cJSON_IsNull(list[k]))) {
            return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                               "part %s: an entry of an answer is no formula in quotes", s->p->id);
        }

        // the formula, or the one that it leaves as it is
        if (text) {
            HN_TRY(hn_draw_parse(s->draw, text, &out->e[k], s->diag));
        } else {
            out->e[k] = base->e[k];
        }

        // its value in every state
        for (int i = 0; i < s->draw->n_states; i++) {
            out->x[k][i] = hn_draw_eval(s->draw, out->e[k], i);
        }
    }
    return HN_OK;
}

void hn_value_tolerance(const hn_part *p, double *relative, double *absolute) {
    const int symbolic = hn_value_is_symbolic(p);
    const cJSON *tolerance = cJSON_GetObjectItemCaseSensitive(p->node, "tolerance");
    *relative = hn_part_number(tolerance, "relative", symbolic ? 1e-6 : 5e-3);
    *absolute = hn_part_number(tolerance, "absolute", symbolic ? 1e-9 : 1e-12);
}

double hn_value_allowed(double relative, double absolute, double size) {
    return fmax(absolute, relative * size);
}

static hn_status set_tolerance(hn_value_sheet *s) {
    double relative, absolute;
    hn_value_tolerance(s->p, &relative, &absolute);
    for (int k = 0; k < s->reference.n; k++) {
        double size = 0;
        for (int i = 0; i < s->draw->n_states; i++) {
            if (!isfinite(s->reference.x[k][i])) {
                return hn_diag_set(s->diag, HN_ERR_INPUT, "/parts/answer", NULL,
                                   "part %s: the reference is not finite with the numbers of this "
                                   "variant",
                                   s->p->id);
            }
            size = fmax(size, fabs(s->reference.x[k][i]));
        }
        s->allowed[k] = hn_value_allowed(relative, absolute, size);
    }
    return HN_OK;
}

hn_status hn_value_open(hn_value_sheet *s, const hn_part *p, hn_draw *draw, hn_diag *diag) {
    *s = (hn_value_sheet){.p = p, .draw = draw, .diag = diag, .symbolic = hn_value_is_symbolic(p)};
    const cJSON *states = cJSON_GetObjectItemCaseSensitive(p->node, "states");
    const int n = states || s->symbolic ? STATES : 1;
    HN_TRY(hn_draw_init(draw, states, cJSON_GetObjectItemCaseSensitive(p->node, "conditions"),
                        p->draw, n, p->seed ^ 0x5ca1ab1e, diag));
    if (!hn_unit_parse(hn_part_text(p->node, "unit"), &s->unit)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts/unit", NULL, "part %s: no unit '%.40s'",
                           p->id, hn_part_text(p->node, "unit"));
    }
    HN_TRY(
        hn_value_read(s, cJSON_GetObjectItemCaseSensitive(p->node, "answer"), NULL, &s->reference));
    return set_tolerance(s);
}

bool hn_value_is_count(const hn_value_sheet *s) {
    bool count = !s->symbolic && s->reference.n > 0 && !hn_part_text(s->p->node, "unit")[0];
    for (int k = 0; k < s->reference.n; k++) {
        // a drawn whole number may be off by rounding, far below 1e-9
        const double right = s->reference.x[k][0];
        count = count && fabs(right - round(right)) < 1e-9;
    }
    return count;
}

int hn_value_is_right(const hn_value_sheet *s, int k, const double *given) {
    for (int i = 0; i < s->draw->n_states; i++) {
        if (!(fabs(given[i] - s->reference.x[k][i]) <= s->allowed[k])) {
            return 0;
        }
    }
    return 1;
}
