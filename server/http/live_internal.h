#ifndef HN_HTTP_LIVE_INTERNAL_H
#define HN_HTTP_LIVE_INTERNAL_H
// Shared by live.c (thread and publishing), patch.c (changes) and stream.c (readers).

#include "http/live.h"
#include "http/request.h"

#include <pthread.h>

/// What is being compared; replaced as a whole.
typedef struct hn_bench {
    hn_scene_order scene;
    hn_model *model;
    hn_comparison *comparison;
    int told[HN_COMPARISON_MAX_METHODS]; ///< incidents told already, per method
    size_t told_length
        [HN_COMPARISON_MAX_METHODS]
        [HN_RUN_MAX_INCIDENTS]; ///< of their messages then: one that has grown since is told again
} hn_bench;

struct hn_live {
    pthread_mutex_t lock;
    pthread_cond_t wake; ///< of the thread
    int refs;
    char id[17];
    const hn_http_opts *opts;
    const hn_library *lib;
    void (*gone)(void *user);
    void *user;

    // the thread's own
    hn_bench bench;
    double asked_frame_dt, asked_duration;

    // published: written by the thread under the lock, read by all under the lock
    hn_live_state state;
    double speed;
    long long frame, generation;
    double lag;         ///< real time by which the frames came too late, in all [s]
    double anchor_time; ///< pacing: frame `anchor_frame` was due then
    long long anchor_frame;
    double frame_dt, duration;
    hn_strbuf scene_json, comparison_json, settings_json, latest;
    hn_history history;

    // under the lock, by anybody
    hn_request *patches, **patches_end; ///< queue
    struct hn_stream *streams;          ///< list
    int n_streams;
    double touched; ///< last look by anybody [s, monotonic]
    int ending, deleted, thread_ended;
};

double hn_now(void); ///< monotonic [s]

/// A model and its runs. On failure nothing is left in *bench.
HN_MUST_CHECK hn_status hn_bench_create(const hn_live *live, const hn_scene_order *scene,
                                        const char *const *methods, int n_methods, hn_bench *bench,
                                        hn_diags *diags);
void hn_bench_reset(hn_bench *bench);

// for the thread; none may be called with the lock held
/// Writes out what does not change from frame to frame. HN_ERR_MEMORY leaves the old texts.
HN_MUST_CHECK hn_status hn_live_publish_setup(hn_live *live);
/// The present frame as an event, then its incidents, then the end if it is reached.
void hn_live_publish_frame(hn_live *live);
/// One frame further.
void hn_live_advance(hn_live *live);
void hn_live_set_state(hn_live *live, hn_live_state state, const char *reason);
/// Carries out the body of a PATCH and fills in the reply.
void hn_live_apply(hn_live *live, hn_request *r);

// with the lock held
void hn_live_put_json(hn_strbuf *b, const hn_live *live);
void hn_live_put_state(hn_strbuf *b, const hn_live *live); ///< members "state" and "speed"
void hn_live_wake_streams(hn_live *live);
void hn_live_set_anchor(hn_live *live);
#endif
