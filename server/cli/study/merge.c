// SPDX-License-Identifier: GPL-3.0-or-later
// holonom merge PART...: joins the parts of a study.
#include "base/file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/forms.h"
#include "cli/study/work_precision_text.h"
#include "session/kinds/job.h"
#include "session/precision/study.h"
#include "session/precision/study_merge.h"

enum {
    MOST_BYTES = 64 << 20
}; // of a part: some hundred points with their coordinates take less than one

HN_JOB_FORM(text, hn_study, hn_study_text)

/// Returns the kind of job that the merged parts make.
static const hn_job_kind *merged(void) {
    return hn_job_kind_find("work-precision");
}

static hn_status merge_files(const hn_args *args, hn_strbuf *texts, hn_study **out,
                             hn_diags *diags) {
    hn_study_part_text parts[HN_CLI_MAX_WORDS];
    hn_status status = hn_forms_check(merged()->forms, args, diags);
    for (int i = 0; i < args->words.n && status == HN_OK; i++) {
        status = hn_file_load(args->words.word[i], MOST_BYTES, &texts[i], diags);
        parts[i] = (hn_study_part_text){args->words.word[i], hn_strbuf_text(&texts[i]), texts[i].n};
    }
    return status == HN_OK ? hn_study_merge(parts, args->words.n, out, diags) : status;
}

hn_exit hn_command_merge(const hn_library *lib, const hn_args *args) {
    (void)lib; // the scene comes with the parts
    hn_strbuf texts[HN_CLI_MAX_WORDS];
    hn_diags diags = {0};
    hn_study *study = NULL;
    for (int i = 0; i < HN_CLI_MAX_WORDS; i++) {
        hn_strbuf_init(&texts[i]);
    }
    const hn_status status = merge_files(args, texts, &study, &diags);
    for (int i = 0; i < HN_CLI_MAX_WORDS; i++) {
        hn_strbuf_reset(&texts[i]);
    }
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    const hn_exit result = hn_forms_write(merged()->forms, put_text, args, study);
    hn_study_free(study);
    return result;
}
