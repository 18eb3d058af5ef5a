// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SESSION_H
#define HN_HTTP_SESSION_H
// One comparison as a resource. A thread of its own owns the model and the runs, paces the frames
// and carries out changes in the order they come; everybody else reads what it has published, under
// the lock. Every holder of a pointer holds a reference.

#include "http/ground/http_opts.h"
#include "http/ground/shares.h"
#include "http/live/history.h"
#include "http/request/scene_request.h"
#include "session/compare/comparison.h"
#include "session/model/library.h"

#include <stdatomic.h>

struct hn_request;
struct hn_stream;

typedef enum hn_session_state {
    HN_SESSION_PAUSED,
    HN_SESSION_RUNNING,
    HN_SESSION_FINISHED
} hn_session_state;

typedef struct hn_session hn_session;

/// The request of a new comparison. Texts are copied.
typedef struct hn_session_request {
    const hn_scene_request *scene;
    const char *const *methods;
    int n_methods;
    const hn_pull_event *pulls; ///< what the hand does; the scene names their points
    int n_pulls;
    double frame_dt, duration; ///< 0: chosen, the scene's
    double speed;
    int running;
    hn_client client;
    struct hn_request *maker;   ///< who asks, until it is made
    const atomic_int *stopping; ///< the server ends
} hn_session_request;

/// Loads, compiles (and makes way for others meanwhile) and starts the thread. `gone(user)` is
/// called when the thread ends. Returns one reference. HN_ERR_STOPPED where equations took longer
/// than run_cpu_s, the server ends, or the client of `maker` has gone.
HN_MUST_CHECK hn_status hn_session_create(const hn_http_opts *opts, const hn_library *lib,
                                          const hn_session_request *order, void (*gone)(void *user),
                                          void *user, hn_session **out, hn_diags *diags);
hn_session *hn_session_retain(hn_session *session);
void hn_session_release(hn_session *session);
hn_client hn_session_client(const hn_session *session); ///< who made it
/// Returns the seconds since anybody read it or asked for it; 0 while a stream is open.
double hn_session_untouched(hn_session *session);
const char *hn_session_id(const hn_session *session);
/// The description; counts as a reader's look.
void hn_session_json(hn_strbuf *b, hn_session *session);
/// Appends the changes of the hand: {"generation","frame_dt","pulls":[[frame, point, x, y, z,
/// stiffness, damping], ...]}
void hn_session_pulls_json(hn_strbuf *b, hn_session *session);
/// Hands over a suspended PATCH request with its body: the thread carries it out and answers.
/// Answers itself when the thread has ended.
void hn_session_patch(hn_session *session, struct hn_request *r);
/// The thread ends and streams are closed, with the event `end` when it was `deleted` (rather than
/// the server stopping).
void hn_session_end(hn_session *session, int deleted);
/// Wakes the streams for their keep-alive; to be called every second or so. Returns 1 where nobody
/// has used the session for so long that it should be ended.
int hn_session_tick(hn_session *session);
#endif
