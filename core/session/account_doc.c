#include "session/account_doc.h"

#include "base/json_text.h"
#include "study/account.h"

#include <math.h>

enum { MOST_METHODS = 24 };

typedef struct share {
    const hn_accounts_request *request;
    int m, n;
} share;

static int ask_stop(void *user) {
    const share *s = user;
    return s->request->stop && s->request->stop(s->request->user);
}

static void tell_progress(void *user, double part) {
    const share *s = user;
    if (s->request->progress) {
        s->request->progress(s->request->user, (s->m + part) / s->n);
    }
}

static void put_or_null(hn_strbuf *b, const char *key, double value) {
    if (isfinite(value)) {
        hn_json_put_number(b, key, value);
    } else {
        hn_json_key(b, key);
        hn_json_null(b);
    }
}

static void put_error(hn_strbuf *b, const hn_model *model, const hn_account *a) {
    hn_json_key(b, "error");
    if (a->coordinate < 0) {
        hn_json_null(b);
        return;
    }
    const hn_coordinate *c =
        &hn_model_scene(model)
             ->coordinates[hn_system_user_coordinate(hn_model_system(model), a->coordinate)];
    hn_json_object(b);
    hn_json_put_string(b, "coordinate", c->name);
    hn_json_put_string(b, "unit", c->kind == HN_LENGTH ? "m" : "rad");
    put_or_null(b, "value", a->error);
    put_or_null(b, "sum", a->sum);
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_CAUSE_COUNT; i++) {
        const int unknown = i == HN_CAUSE_FORMULATION && !a->has_equations;
        put_or_null(b, hn_cause_name((hn_cause)i), unknown ? (double)NAN : a->part[i]);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_energy(hn_strbuf *b, const hn_account *a) {
    hn_json_key(b, "energy");
    hn_json_object(b);
    put_or_null(b, "change", a->energy);
    put_or_null(b, "swing", a->swing);
    hn_json_key(b, "conservative");
    hn_json_bool(b, a->conservative);
    put_or_null(b, "loops_back_and_forth", a->loop_work_abs);
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < HN_BILL_COUNT; i++) {
        const int unknown = i == HN_BILL_FORMULATION && !a->has_equations;
        put_or_null(b, hn_bill_name((hn_bill_item)i), unknown ? (double)NAN : a->bill[i]);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_account(hn_strbuf *b, const hn_model *model, const hn_method_spec *spec,
                        const hn_account *a, hn_status status, const hn_diag *diag) {
    char spelling[HN_SPEC_MAX];
    const int failed = a->state == HN_RUN_FAILED;
    hn_method_format(spec, spelling);
    hn_json_object(b);
    hn_json_put_string(b, "method", spelling);
    hn_json_put_string(b, "state", status != HN_OK ? "refused" : failed ? "failed" : "done");
    hn_json_put_string(b, "reason", status != HN_OK ? diag->message : a->reason);
    if (status == HN_OK) {
        hn_json_put_number(b, "t", a->t);
        hn_json_put_int(b, "steps", a->steps);
        put_error(b, model, a);
        put_energy(b, a);
    }
    hn_json_end_object(b);
}

static hn_status parse_all(const char *const *methods, int n, hn_method_spec *specs,
                           hn_diags *diags) {
    if (n > MOST_METHODS) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/methods", NULL,
                            "%d methods were given; %d are the most", n, MOST_METHODS);
    }
    for (int i = 0; i < n; i++) {
        hn_diag diag = {0};
        const hn_status status = hn_method_parse(methods[i], &specs[i], &diag);
        if (status != HN_OK) {
            return hn_diags_add(diags, status, "/methods", diag.hint, "%s", diag.message);
        }
    }
    return HN_OK;
}

hn_status hn_accounts_json(hn_strbuf *b, const hn_model *model, const hn_accounts_request *request,
                           hn_diags *diags) {
    const hn_scene *scene = hn_model_scene(model);
    const char *const *methods = request->n_methods > 0 ? request->methods : scene->methods;
    const int n = request->n_methods > 0 ? request->n_methods : scene->n_methods;
    const double T = isnan(request->time) ? scene->duration : request->time;
    hn_method_spec specs[MOST_METHODS];
    hn_status status = parse_all(methods, n, specs, diags);
    if (status == HN_OK && !(T > 0)) {
        status = hn_diags_add(diags, HN_ERR_INPUT, "/time", NULL,
                              "the end time is %g s; it must be above 0", T);
    }
    if (status != HN_OK) {
        return status;
    }
    share told = {request, 0, n};
    const hn_account_opts opts = {.stop = ask_stop, .progress = tell_progress, .user = &told};
    hn_json_object(b);
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    hn_json_put_number(b, "time", T);
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (; status != HN_ERR_BUDGET && told.m < n; told.m++) {
        hn_account a;
        hn_diag diag = {0};
        status = hn_account_make(hn_model_system(model), &specs[told.m], hn_model_q(model),
                                 hn_model_v(model), T, &opts, &a, &diag);
        put_account(b, model, &specs[told.m], &a, status, &diag);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
    return b->failed ? HN_ERR_MEMORY : status == HN_ERR_BUDGET ? status : HN_OK;
}
