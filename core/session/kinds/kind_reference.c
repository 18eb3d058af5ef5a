// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/kinds/kind_reference.h"

#include "session/kinds/job.h"
#include "session/references/reference_doc.h"
#include "session/references/reference_store.h"

#include <math.h>
#include <stdlib.h>

static const hn_field FIELDS[] = {
    HN_JOB_TIME_FIELD,
    HN_JOB_TIME_LIMIT_FIELD("none when left out"),
    {.name = "recompute",
     .type = HN_FIELD_BOOL,
     .argument = "",
     .about = "ignore shipped and cached references"},
    {.name = "hold",
     .type = HN_FIELD_BOOL,
     .argument = "",
     .about = "end the reference early where fewer than 6 digits are sure"},
    HN_JOB_END_OF_FIELDS,
};

static hn_status open_reference(const hn_job_request *r, void **work, hn_diags *diags) {
    hn_job_request checked = *r;
    HN_TRY(hn_job_complete(&checked, 0, 0, NULL, diags));
    hn_reference_work *w = calloc(1, sizeof *w);
    if (!w) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    w->model = r->models[0];
    *work = w;
    return HN_OK;
}

static void pass_progress(void *user, double share) {
    hn_job_progress(user, "", share);
}

/// Computes the reference again, to the time up to which its digits hold.
static hn_status shorten(hn_reference_work *w, hn_ref_request *request, hn_diags *diags) {
    const double hold = hn_reference_horizon(w->ref, HN_HOLD_DIGITS);
    if (hold == w->ref->T) {
        return HN_OK;
    }
    if (hold <= 0) {
        return hn_diags_add(diags, HN_ERR_NO_CONVERGENCE, NULL, "take a shorter time",
                            "the two computations agree on fewer than %d digits from the start on",
                            HN_HOLD_DIGITS);
    }
    hn_ref_free(w->ref);
    w->ref = NULL;
    request->time = hold;
    return hn_reference_get(w->model, request, &w->ref, NULL, diags);
}

static hn_status run(void *work, const hn_job_request *r, hn_job_end *end, hn_diags *diags) {
    (void)end;
    hn_reference_work *w = work;
    hn_job_limits limits = r->limits;
    hn_ref_request request = hn_ref_request_default();
    request.time = r->time;
    request.folder = limits.folder;
    request.again = hn_job_number(r, "recompute", 0) > 0;
    request.opts.limits = (hn_walk_limits){isnan(limits.time_limit) ? 0 : limits.time_limit,
                                           limits.stop, limits.user};
    request.opts.progress = pass_progress;
    request.opts.user = &limits;
    HN_TRY(hn_reference_get(w->model, &request, &w->ref, &w->source, diags));
    return hn_job_number(r, "hold", 0) > 0 ? shorten(w, &request, diags) : HN_OK;
}

static void release(void *work) {
    hn_ref_free(((hn_reference_work *)work)->ref);
    free(work);
}

static void write_json(hn_strbuf *b, const hn_reference_work *w) {
    hn_reference_json(b, w->model, w->ref, w->source);
}
HN_JOB_FORM(json, hn_reference_work, write_json)

/// The form in which scenes ship their references.
static void save(hn_strbuf *b, const void *work) {
    const hn_reference_work *w = work;
    hn_reference_put(b, w->model, w->ref);
    hn_strbuf_add(b, "\n");
}

const hn_job_kind hn_kind_reference = {
    .name = "reference",
    .about = "the reference solution, computed in two ways, with the digits on which they agree",
    .command = "reference",
    .pieces = "",
    .chooses = "",
    .fields = FIELDS,
    .forms = {{".json", put_json}},
    .open = open_reference,
    .run = run,
    .release = release,
    .save = save,
};
