// SPDX-License-Identifier: GPL-3.0-or-later
// Changes that PATCH can make. Everything that can fail is tried before anything is changed, so
// that a request at fault leaves the comparison as it was.
#include "http/live/patch.h"

#include "base/clock.h"
#include "http/live/pulls.h"
#include "session/job/field.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// Steps on request are not interrupted by other requests for so long [s].
static const double UNDISTURBED = 0.2;
/// Frames computed again for a point that is pulled for the first time are not interrupted for so
/// long [s].
static const double CATCHING_UP = 10;

/// The body, read.
typedef struct change {
    const cJSON *methods, *settings, *set, *pull, *pulls;
    int wants_state, run, reset, step;
    bool release; ///< the hand lets go
    bool is_new;  ///< the point of `pull` was not pulled before
    double speed; ///< 0: as it is
    hn_pull hand; ///< of `pull`
} change;

static change read_change(const cJSON *body) {
    const char *state = hn_fields_text(body, "state");
    return (change){
        .methods = cJSON_GetObjectItemCaseSensitive(body, "methods"),
        .settings = cJSON_GetObjectItemCaseSensitive(body, "parameters"),
        .set = cJSON_GetObjectItemCaseSensitive(body, "set"),
        .pull = cJSON_GetObjectItemCaseSensitive(body, "pull"),
        .pulls = cJSON_GetObjectItemCaseSensitive(body, "pulls"),
        .release = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(body, "release")),
        .wants_state = state != NULL,
        .run = state && strcmp(state, "running") == 0,
        .reset = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(body, "reset")),
        .step = (int)hn_fields_number(body, "step", 0),
        .speed = hn_fields_number(body, "speed", 0),
    };
}

/// Returns whether the clock goes back to 0.
static bool starts_anew(const change *c) {
    return c->methods || c->settings || c->reset || c->pulls;
}

/// 1 when the change fits the state; otherwise the reply is a problem.
static bool fits_state(const hn_session *session, const change *c, hn_request *r) {
    int restart = starts_anew(c);
    int running = c->wants_state ? c->run : session->state == HN_SESSION_RUNNING;
    if (c->step > 0 && running) {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, "send \"state\": \"paused\" as well",
                         "a running comparison cannot be stepped");
        return false;
    }
    if (session->state == HN_SESSION_FINISHED && !restart &&
        (c->step > 0 || c->pull || (c->wants_state && c->run))) {
        hn_reply_problem(r, HN_PROBLEM_CONFLICT, "send \"reset\": true as well",
                         "the comparison has finished");
        return false;
    }
    return true;
}

/// The spellings the new runs are made from: those asked, or the present ones with what was changed
/// while running.
static int choose_methods(const hn_session *session, const cJSON *asked, char (*kept)[HN_SPEC_MAX],
                          const char **methods) {
    int n = 0;
    const cJSON *item;
    if (asked) {
        cJSON_ArrayForEach(item, asked) {
            methods[n++] = item->valuestring;
        }
        return n;
    }
    for (; n < hn_comparison_n_methods(session->bench.comparison); n++) {
        hn_method_format(hn_run_spec(hn_comparison_run(session->bench.comparison, n)), kept[n]);
        methods[n] = kept[n];
    }
    return n;
}

/// Finds what the hand does in what is built: as asked, or as it did so far.
static hn_status choose_pulls(const hn_session *session, const change *c, hn_pull_list *pulls,
                              hn_diags *diags) {
    const hn_comparison *now = session->bench.comparison;
    return c->pulls ? hn_pull_list_read(c->pulls, pulls, diags)
                    : hn_pull_list_copy(now, hn_comparison_frame_dt(now), pulls);
}

/// A new model, with other settings or other points that a hand may pull.
static hn_status build_model(hn_session *session, const change *c, const char *const *methods,
                             int n, hn_subject *fresh, hn_diags *diags) {
    hn_scene_request scene = {0};
    hn_pull_list pulls = {0};
    hn_status status = hn_scene_request_copy(&scene, &session->bench.scene);
    if (status == HN_OK && c->settings) {
        status = hn_scene_request_read_settings(&scene, c->settings, diags);
    }
    HN_THEN(status, choose_pulls(session, c, &pulls, diags));
    HN_THEN(status, hn_pull_list_name_points(&pulls, &scene, diags));
    if (status == HN_OK && c->pull) {
        status = hn_scene_request_add_pull(&scene, c->hand.point, diags);
    }
    HN_THEN(status, hn_subject_create(session, &scene, methods, n, fresh, diags));
    HN_THEN(status, hn_pull_list_give(&pulls, fresh->comparison, diags));
    hn_pull_list_reset(&pulls);
    hn_scene_request_reset(&scene);
    return status;
}

/// Finds what the change asks for; new methods run on the model that is there (then fresh->model is
/// NULL), unless a hand has pulled it.
static hn_status build(hn_session *session, const change *c, hn_subject *fresh, hn_diags *diags) {
    char kept[HN_COMPARISON_MAX_METHODS][HN_SPEC_MAX];
    const char *methods[HN_COMPARISON_MAX_METHODS];
    int n = choose_methods(session, c->methods, kept, methods);
    if (!c->settings && !c->pulls && !c->is_new && session->bench.scene.n_pulls == 0) {
        return hn_subject_compare(session, session->bench.model, methods, n, &fresh->comparison,
                                  diags);
    }
    return build_model(session, c, methods, n, fresh, diags);
}

/// Puts what was built in the place of what is there.
static void replace(hn_session *session, hn_subject *fresh) {
    if (fresh->model) {
        session->published = NULL; // a new model may lie where the old one did
        hn_subject_reset(&session->bench);
        session->bench = *fresh;
    } else {
        hn_comparison_free(session->bench.comparison);
        session->bench.comparison = fresh->comparison;
        memset(session->bench.published, 0, sizeof session->bench.published);
    }
    *fresh = (hn_subject){0};
}

/// {"method":1,"key":"alpha","value":20}
static hn_status set_running(hn_subject *bench, const cJSON *set, hn_diags *diags) {
    hn_diag diag = {0};
    hn_status status =
        hn_comparison_set(bench->comparison, (int)hn_fields_number(set, "method", -1),
                          hn_fields_text(set, "key"), hn_fields_number(set, "value", 0), &diag);
    if (status != HN_OK) {
        const char *pointer = strncmp(diag.pointer, "/set", 4) == 0 ? diag.pointer : "/set/value";
        hn_diags_add(diags, status, pointer, diag.hint, "%s", diag.message);
    }
    return status;
}

/// A new start: the clock back to 0, a new generation, the event `reset` with the whole
/// description, frame 0.
static hn_status restart(hn_session *session) {
    pthread_mutex_lock(&session->lock);
    session->generation++;
    session->frame = 0;
    session->lag = 0;
    session->slow = (hn_slow_frame){0};
    if (session->state == HN_SESSION_FINISHED) {
        session->state = HN_SESSION_PAUSED;
    }
    hn_session_set_anchor(session);
    hn_strbuf_clear(&session->latest);
    hn_strbuf_clear(&session->pulls_json);
    session->n_pulls = 0;
    pthread_mutex_unlock(&session->lock);

    // readers get the whole description, then frame 0
    hn_session_publish_pulls(session);
    hn_status status = hn_session_publish_setup(session);
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&session->lock);
    hn_json_object(&b);
    hn_json_put_int(&b, "generation", session->generation);
    hn_json_key(&b, "description");
    hn_session_put_json(&b, session);
    hn_json_end_object(&b);
    hn_history_add(&session->history, HN_EVENT_RESET, &b);
    pthread_mutex_unlock(&session->lock);
    hn_session_publish_frame(session);
    return status;
}

static hn_status publish_set(hn_session *session, const cJSON *set) {
    hn_status status = hn_session_publish_setup(session);
    char *text = cJSON_PrintUnformatted(set);
    hn_strbuf b;
    hn_strbuf_init(&b);
    pthread_mutex_lock(&session->lock);
    hn_json_object(&b);
    hn_session_put_state(&b, session);
    hn_json_key(&b, "set");
    hn_json_raw(&b, text ? text : "null");
    hn_json_key(&b, "comparison");
    hn_json_raw(&b, hn_strbuf_text(&session->comparison_json));
    hn_json_end_object(&b);
    hn_history_add(&session->history, HN_EVENT_STATE, &b);
    hn_session_wake_streams(session);
    pthread_mutex_unlock(&session->lock);
    cJSON_free(text);
    return status;
}

/// Frames of a comparison that was built again, up to where it stood.
static void catch_up(hn_session *session, long long frame) {
    session->undisturbed = hn_clock_wall() + CATCHING_UP;
    while (session->frame < frame && hn_session_advance(session) &&
           session->state != HN_SESSION_FINISHED) {}
    session->undisturbed = 0;
    pthread_mutex_lock(&session->lock);
    hn_session_set_anchor(session);
    pthread_mutex_unlock(&session->lock);
}

/// Tells the comparison, and writes down, what the hand does from the present frame on.
static hn_status pull(hn_session *session, const change *c) {
    hn_comparison *of = session->bench.comparison;
    const hn_pull_event *events;
    const int n = hn_comparison_pulls(of, &events);
    hn_pull hand = c->hand;
    if (c->release && n == 0) {
        return HN_OK;
    }
    if (c->release) {
        hand = events[n - 1].pull;
        hand.stiffness = hand.damping = 0;
    }
    const hn_status status = hn_comparison_pull(of, &hand, NULL);
    hn_session_publish_pulls(session);
    return status;
}

/// Nothing here can be at fault any more, but what memory and the length of a log allow.
static hn_status carry_out(hn_session *session, const change *c, hn_subject *fresh) {
    hn_status status = HN_OK;
    const long long frame = session->frame;
    if (fresh->comparison) {
        replace(session, fresh);
    } else if (c->reset) {
        hn_comparison_reset(session->bench.comparison);
    }
    if (starts_anew(c) || c->is_new) {
        status = restart(session);
    }
    if (c->is_new && !starts_anew(c)) {
        catch_up(session, frame);
    }
    if (status == HN_OK && (c->pull || c->release)) {
        status = pull(session, c);
    }
    if (c->set && status == HN_OK) {
        status = publish_set(session, c->set);
    }
    int run = c->wants_state ? c->run : session->state == HN_SESSION_RUNNING;
    int changes_state = c->wants_state && session->state != HN_SESSION_FINISHED &&
                        c->run != (session->state == HN_SESSION_RUNNING);
    if (changes_state || c->speed > 0) {
        pthread_mutex_lock(&session->lock);
        session->speed = c->speed > 0 ? c->speed : session->speed;
        pthread_mutex_unlock(&session->lock);
        hn_session_set_state(session,
                             session->state == HN_SESSION_FINISHED ? HN_SESSION_FINISHED
                             : run                                 ? HN_SESSION_RUNNING
                                                                   : HN_SESSION_PAUSED,
                             NULL);
    }

    // steps that take long make way for a later request, as the end does at once
    session->undisturbed = c->step > 0 ? hn_clock_wall() + UNDISTURBED : 0;
    for (int k = 0; k < c->step && session->state != HN_SESSION_FINISHED; k++) {
        if (!hn_session_advance(session)) {
            break;
        }
    }
    session->undisturbed = 0;
    return status;
}

/// The hand of the change, and whether its point was ever pulled.
static void find_hand(const hn_session *session, change *c) {
    if (!c->pull) {
        return;
    }
    c->hand = hn_pull_read(c->pull);
    c->is_new = true;
    for (int i = 0; i < session->bench.scene.n_pulls; i++) {
        c->is_new &= session->bench.scene.pulls[i] != c->hand.point;
    }
}

/// Checks where the hand is: the comparison takes it only when the change has been made.
static hn_status check_hand(const change *c, hn_diags *diags) {
    hn_status status = HN_OK;
    for (int k = 0; c->pull && k < 3; k++) {
        if (!(fabs(c->hand.to[k]) <= HN_SCENE_MAX_NUMBER)) {
            char pointer[32];
            snprintf(pointer, sizeof pointer, "/pull/to/%d", k);
            status = hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL,
                                  "entry %d of 'to' is %g; %g to %g are allowed", k + 1,
                                  c->hand.to[k], -HN_SCENE_MAX_NUMBER, HN_SCENE_MAX_NUMBER);
        }
    }
    return status;
}

void hn_session_apply(hn_session *session, hn_request *r) {
    if (!hn_request_read_body(r)) {
        return;
    }
    change c = read_change(r->json);
    find_hand(session, &c);
    if (!fits_state(session, &c, r)) {
        return;
    }

    // everything that can fail, then the change
    hn_subject fresh = {0};
    hn_diags diags = {0};
    hn_status status = check_hand(&c, &diags);
    hn_session_limit_equations(session, c.settings || c.pulls || c.is_new);
    if (status == HN_OK && (c.methods || c.settings || c.pulls || c.is_new)) {
        status = build(session, &c, &fresh, &diags);
    }
    if (session->interrupted) {
        diags.n = 0;
        status = HN_ERR_STOPPED;
    }
    hn_session_limit_equations(session, false);
    if (status == HN_OK && c.set) {
        status = set_running(fresh.comparison ? &fresh : &session->bench, c.set, &diags);
    }
    HN_THEN(status, carry_out(session, &c, &fresh));
    hn_subject_reset(&fresh);
    if (status != HN_OK) {
        hn_reply_diags(r, status, &diags);
        return;
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_session_json(&b, session);
    hn_reply_json(r, MHD_HTTP_OK, &b);
}
