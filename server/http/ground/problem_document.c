// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/problem_document.h"

static const hn_http_problem_info INFOS[HN_PROBLEM_COUNT] = {
#define HN_PROBLEM_ROW(kind, status, code, title, about) {status, code, title, about},
    HN_PROBLEM_LIST(HN_PROBLEM_ROW)
#undef HN_PROBLEM_ROW
};

const hn_http_problem_info *hn_http_problem_get_info(hn_http_problem kind) {
    return &INFOS[kind];
}

static void put_errors(hn_strbuf *b, const hn_diags *diags) {
    hn_json_key(b, "errors");
    hn_json_array(b);
    for (int i = 0; i < diags->n; i++) {
        const hn_diag *d = &diags->item[i];
        hn_json_object(b);
        hn_json_put_string(b, "detail", d->message);
        hn_json_put_string(b, "pointer", d->pointer);
        if (d->hint[0]) {
            hn_json_put_string(b, "hint", d->hint);
        }
        if (d->column > 0) {
            hn_json_put_int(b, "column", d->column);
        }
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    if (diags->found > diags->n) {
        hn_json_put_int(b, "errors_found", diags->found);
    }
}

void hn_http_problem_json(hn_strbuf *b, hn_http_problem kind, const char *detail, const char *hint,
                          const char *instance, long long offset, const hn_diags *diags) {
    const hn_http_problem_info *info = &INFOS[kind];
    hn_strbuf type;
    hn_strbuf_init(&type);
    hn_strbuf_printf(&type, "/api/v1/errors/%s", info->code);
    hn_json_object(b);
    hn_json_put_string(b, "type", hn_strbuf_text(&type));
    hn_json_put_string(b, "title", info->title);
    hn_json_put_int(b, "status", info->status);
    hn_json_put_string(b, "detail", detail);

    // members that only some kinds have
    if (hint && *hint) {
        hn_json_put_string(b, "hint", hint);
    }
    if (instance) {
        hn_json_put_string(b, "instance", instance);
    }
    if (offset >= 0) {
        hn_json_put_int(b, "offset", offset);
    }
    if (diags && diags->n > 0) {
        put_errors(b, diags);
    }
    hn_json_end_object(b);
    b->failed |= type.failed;
    hn_strbuf_reset(&type);
}
