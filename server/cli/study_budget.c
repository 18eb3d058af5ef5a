// holonom study SCENE budget: where the error at the end comes from, and the energy.
#include "cli/document.h"
#include "cli/study.h"
#include "session/account_doc.h"
#include "study/account.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void show_progress(void *user, double share) {
    hn_progress_tell(user, "budget", share);
}

static hn_status check_args(const hn_args *args, hn_diags *diags) {
    if (args->out && !hn_path_ends_in(args->out, ".json")) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out", "end it in .json",
                            "what to write into '%.200s' cannot be told from its name", args->out);
    }
    return HN_OK;
}

static void put_methods_not_done(hn_strbuf *b, const cJSON *methods) {
    const cJSON *m;
    cJSON_ArrayForEach(m, methods) {
        if (strcmp(hn_document_text(m, "state"), "done") != 0) {
            hn_strbuf_printf(b, "  %s: %s, %s\n", hn_document_text(m, "method"),
                             hn_document_text(m, "state"), hn_document_text(m, "reason"));
        }
    }
}

/// A part as a quantity; "-" where it cannot be told.
static void put_part(hn_table *t, const cJSON *parts, const char *name, const char *unit) {
    hn_table_quantity(t, hn_document_number(parts, name), unit);
}

static void put_errors(hn_strbuf *b, const cJSON *methods) {
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "method", 0);
    hn_table_column(&t, "error of", 0);
    hn_table_column(&t, "at the end", 1);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_table_column(&t, hn_cause_name((hn_cause)i), 1);
    }
    hn_table_column(&t, "their sum", 1);
    const cJSON *m;
    cJSON_ArrayForEach(m, methods) {
        const cJSON *error = hn_document_get(m, "error");
        if (!cJSON_IsObject(error)) {
            continue;
        }
        const char *unit = hn_document_text(error, "unit");
        hn_table_cell(&t, "%s", hn_document_text(m, "method"));
        hn_table_cell(&t, "%s", hn_document_text(error, "coordinate"));
        hn_table_quantity(&t, hn_document_number(error, "value"), unit);
        for (int i = 0; i < HN_CAUSE_COUNT; i++) {
            put_part(&t, hn_document_get(error, "parts"), hn_cause_name((hn_cause)i), unit);
        }
        hn_table_quantity(&t, hn_document_number(error, "sum"), unit);
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static void put_energies(hn_strbuf *b, const cJSON *methods) {
    hn_table t;
    hn_table_init(&t);
    hn_table_column(&t, "method", 0);
    hn_table_column(&t, "to t", 1);
    hn_table_column(&t, "change", 1);
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        hn_table_column(&t, hn_bill_name((hn_bill_item)i), 1);
    }
    const cJSON *m;
    cJSON_ArrayForEach(m, methods) {
        const cJSON *energy = hn_document_get(m, "energy");
        if (!energy) {
            continue;
        }
        hn_table_cell(&t, "%s", hn_document_text(m, "method"));
        hn_table_quantity(&t, hn_document_number(m, "t"), "s");
        hn_table_quantity(&t, hn_document_number(energy, "change"), "J");
        for (int i = 0; i < HN_BILL_COUNT; i++) {
            put_part(&t, hn_document_get(energy, "parts"), hn_bill_name((hn_bill_item)i), "J");
        }
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static void put_legend(hn_strbuf *b) {
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_cause_name((hn_cause)i),
                         hn_cause_about((hn_cause)i));
    }
    for (int i = HN_BILL_LOOPS; i < HN_BILL_COUNT; i++) {
        hn_strbuf_printf(b, "  %-12s %s\n", hn_bill_name((hn_bill_item)i),
                         hn_bill_about((hn_bill_item)i));
    }
    hn_strbuf_add(b, "  A formulation without equations of its own has its part in truncation; "
                     "\"-\": it cannot be told.\n");
}

static void put_text(hn_strbuf *b, const cJSON *document) {
    const cJSON *methods = hn_document_get(document, "methods");
    hn_strbuf_printf(b, "%s, to t = %g s\n\nWhere the error at the end comes from\n",
                     hn_document_text(document, "title"), hn_document_number(document, "time"));
    put_errors(b, methods);
    hn_strbuf_add(b, "\nWho put energy in (+) or took it out (-)\n");
    put_energies(b, methods);
    put_methods_not_done(b, methods);
    put_legend(b);
}

static hn_exit write_results(const hn_args *args, hn_strbuf *json) {
    if (args->out) {
        hn_strbuf copy;
        hn_strbuf_init(&copy);
        hn_strbuf_add(&copy, hn_strbuf_text(json));
        const hn_exit written = hn_cli_write_file(args, args->out, &copy);
        if (written != HN_EXIT_DONE) {
            return written;
        }
    }
    if (args->json) {
        return hn_cli_print(json);
    }
    hn_strbuf text;
    hn_strbuf_init(&text);
    cJSON *document = hn_document_parse(json);
    if (document) {
        put_text(&text, document);
    }
    text.failed |= !document;
    cJSON_Delete(document);
    return hn_cli_print(&text);
}

static hn_exit account_for(const hn_library *lib, const hn_args *args, const hn_model *model) {
    (void)lib;
    hn_diags diags = {0};
    hn_progress progress = {0};
    hn_strbuf b;
    const hn_accounts_request request = {
        .methods = args->methods.word,
        .n_methods = args->methods.n,
        .time = args->time,
        .stop = hn_is_interrupted,
        .progress = show_progress,
        .user = &progress,
    };
    hn_strbuf_init(&b);
    hn_interrupt_begin();
    const hn_status status = hn_accounts_json(&b, model, &request, &diags);
    hn_progress_end(&progress);
    hn_interrupt_end();
    if (status != HN_OK && status != HN_ERR_BUDGET) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }
    const hn_exit result = write_results(args, &b);
    return result == HN_EXIT_DONE && status == HN_ERR_BUDGET ? HN_EXIT_ENDED : result;
}

const hn_study_kind hn_study_kind_budget = {
    .name = "budget",
    .about = "where the error at the end comes from, and the energy; --out FILE.json",
    .options = "--set --methods --time --out -o",
    .check = check_args,
    .run = account_for,
};
