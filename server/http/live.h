#ifndef HN_HTTP_LIVE_H
#define HN_HTTP_LIVE_H
// One comparison as a resource. A thread of its own owns the model and the runs, paces the frames and carries out
// changes in the order they come; everybody else reads what it has published, under the lock. Whoever holds a
// pointer holds a reference.

#include "http/body.h"
#include "http/history.h"
#include "http/server.h"
#include "session/compare/comparison.h"

struct hn_request;
struct hn_stream;

typedef enum hn_live_state { HN_LIVE_PAUSED, HN_LIVE_RUNNING, HN_LIVE_FINISHED } hn_live_state;

typedef struct hn_live hn_live;

/// What a new comparison is made of. Texts are copied.
typedef struct hn_live_order {
    const hn_scene_order *scene;
    const char *const *methods;
    int n_methods;
    double frame_dt, duration; ///< 0: chosen, the scene's
    double speed;
    int running;
} hn_live_order;

/// Loads, compiles, and starts the thread. `gone(user)` is called when the thread ends. Returns one reference.
HN_MUST_CHECK hn_status hn_live_create(const hn_http_opts *opts, const hn_library *lib,
                                       const hn_live_order *order, void (*gone)(void *user),
                                       void *user, hn_live **out, hn_diags *diags);
hn_live *hn_live_retain(hn_live *live);
void hn_live_release(hn_live *live);
const char *hn_live_id(const hn_live *live);
/// The description; counts as a reader's look.
void hn_live_json(hn_strbuf *b, hn_live *live);
/// Hands over a suspended PATCH request with its body: the thread carries it out and answers. Answers itself when the thread has ended.
void hn_live_patch(hn_live *live, struct hn_request *r);
/// The thread ends and streams are closed, with the event `end` when it was `deleted` (rather than the server stopping).
void hn_live_end(hn_live *live, int deleted);
/// Now and then: wakes streams for their keep-alive; 1 when nobody has touched it for so long that it should go.
int hn_live_tick(hn_live *live);
#endif
