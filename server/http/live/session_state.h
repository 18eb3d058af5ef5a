// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SESSION_STATE_H
#define HN_HTTP_SESSION_STATE_H
// The data of a session, private and published: for its thread (session.c), its changes (patch.c)
// and its readers (stream.c).

#include "http/live/session.h"
#include "http/live/slow_frame.h"
#include "http/request/request.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

/// The subject of the comparison; replaced as a whole.
typedef struct hn_subject {
    hn_scene_request scene;
    hn_model *model;
    hn_comparison *comparison;
    /// Per method, the revision of the newest incident that was published.
    unsigned published[HN_COMPARISON_MAX_METHODS];
} hn_subject;

/// A reader of the events, as far as the session knows it; the first member of a stream.
typedef struct hn_reader {
    struct MHD_Connection *connection;
    int waiting; ///< the connection is suspended
    struct hn_reader *next;
} hn_reader;

/// Why the thread should leave the frame that it computes.
enum { HN_INTERRUPT_NONE, HN_INTERRUPT_REQUEST, HN_INTERRUPT_END };

struct hn_session {
    pthread_mutex_t lock;
    pthread_cond_t wake; ///< of the thread
    int refs;
    char id[17];
    const hn_http_opts *opts;
    const hn_library *lib;
    void (*gone)(void *user);
    void *user;

    // the thread's own
    hn_subject bench;
    const hn_model *published; ///< whose description scene_json is
    double asked_frame_dt, asked_duration;
    double undisturbed;         ///< before this time no request interrupts [s, wall clock]
    double load_end;            ///< equations must be ready by then [s, thread's own clock]
    bool interrupted;           ///< they were given up
    hn_slow_frame slow;         ///< the frame in progress
    hn_request *maker;          ///< the request that makes the session; NULL on its own thread
    const atomic_int *stopping; ///< the server ends

    // published: written by the thread under the lock, read by all under the lock
    hn_session_state state;
    double speed;
    long long frame, generation;
    double lag;         ///< real time by which the frames came too late, in all [s]
    double due;         ///< when the frame that is computed was due; 0: none is [s, wall clock]
    double anchor_time; ///< pacing: frame `anchor_frame` was due then
    long long anchor_frame;
    double frame_dt, duration;
    hn_strbuf scene_json, comparison_json, settings_json, latest;
    hn_strbuf pulls_json; ///< entries of a list
    int n_pulls;          ///< of them
    hn_history history;

    // under the lock, by anybody
    hn_request *patches, **patches_end; ///< queue
    hn_reader *readers;                 ///< list
    int n_streams, had_streams;
    hn_client client;     ///< who made it
    atomic_int interrupt; ///< what the frame that is being computed is left for
    double touched;       ///< last look by anybody [s, monotonic]
    int ending, deleted, thread_ended;
};

/// A model and its runs. On failure nothing is left in *bench.
HN_MUST_CHECK hn_status hn_subject_create(hn_session *session, const hn_scene_request *scene,
                                          const char *const *methods, int n_methods,
                                          hn_subject *bench, hn_diags *diags);
/// The runs alone, on a model that is there.
HN_MUST_CHECK hn_status hn_subject_compare(const hn_session *session, const hn_model *model,
                                           const char *const *methods, int n_methods,
                                           hn_comparison **out, hn_diags *diags);
void hn_subject_reset(hn_subject *bench);

// for the thread; none may be called with the lock held
/// Limits the time for compiling equations from here on: `limited`: to run_cpu_s of the thread;
/// else it has no limit. The end of the session, or of the server, ends them in any case.
void hn_session_limit_equations(hn_session *session, bool limited);
/// Writes out what does not change from frame to frame. HN_ERR_MEMORY leaves the old texts.
HN_MUST_CHECK hn_status hn_session_publish_setup(hn_session *session);
/// Writes down what the hand has done since the last time; all of it after a restart.
void hn_session_publish_pulls(hn_session *session);
/// The present frame as an event, then its incidents, then the end if it is reached.
void hn_session_publish_frame(hn_session *session);
/// One frame further; 0 when a request, or the end, came before the frame was complete.
int hn_session_advance(hn_session *session);
void hn_session_set_state(hn_session *session, hn_session_state state, const char *reason);

// with the lock held
void hn_session_put_json(hn_strbuf *b, const hn_session *session);
void hn_session_put_state(hn_strbuf *b, const hn_session *session); ///< members "state" and "speed"
void hn_session_wake_streams(hn_session *session);
void hn_session_set_anchor(hn_session *session);
/// Real time by which the frame that is computed comes too late so far; 0 where that is caught up
/// [s].
double hn_session_lateness(const hn_session *session);
void hn_session_set_interrupt(hn_session *session); ///< by what waits
void hn_reader_wake(hn_reader *r);
#endif
