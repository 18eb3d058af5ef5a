// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/jobs.h"

#include "base/clock.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// Weight of the latest job in the mean duration.
static const double LATEST = 0.2;
/// A job works for so long before it makes way [s].
static const double SLICE = 0.2;

typedef enum turn_state { TURN_IDLE, TURN_AT_WORK, TURN_ASIDE } turn_state;

struct hn_job_turn {
    hn_jobs *jobs;
    pthread_t thread;
    turn_state state; ///< under the lock, as are `work`, `client` and `place`
    void *work;
    hn_client client;
    long long place;      ///< in the order of those that wait, while it is aside
    double taken_up;      ///< under the lock too [s, wall clock]
    double look;          ///< it asks the pool then; of its own thread [s, wall clock]
    double begun;         ///< of its present slice; of its own thread [s, wall clock]
    double used;          ///< by its slices before; of its own thread [s]
    _Atomic double share; ///< of its present job that is done, 0 to 1; 0: it says nothing
};

typedef struct waiting_job {
    void *work;
    hn_client client;
    long long place;
} waiting_job;

struct hn_jobs {
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< a thread has something to do
    hn_jobs_opts opts;
    void (*run)(void *work, hn_job_turn *turn);
    waiting_job *waiting; ///< not begun, oldest first
    int n, stopping;
    hn_job_turn *turns; ///< one for each thread
    int n_threads;
    long long places; ///< given so far
    double mean;      ///< working time of a job [s]
};

// ---- who is next; with the lock held ----

static int count_turns(const hn_jobs *jobs, turn_state state) {
    int n = 0;
    for (int i = 0; i < jobs->n_threads; i++) {
        n += jobs->turns[i].state == state;
    }
    return n;
}

static int count_of(const hn_jobs *jobs, turn_state state, hn_client client) {
    int n = 0;
    for (int i = 0; i < jobs->n_threads; i++) {
        n += jobs->turns[i].state == state && jobs->turns[i].client == client;
    }
    return n;
}

static int count_waiting(const hn_jobs *jobs, hn_client client) {
    int n = 0;
    for (int i = 0; i < jobs->n; i++) {
        n += jobs->waiting[i].client == client;
    }
    return n;
}

/// Candidate to be taken up: a job that waits or one that is aside; fewest first, then
/// oldest.
typedef struct candidate {
    int job; ///< index of a job that waits, or -1
    hn_job_turn *turn;
    int at_work; ///< jobs of its client
    long long place;
} candidate;

static void consider(candidate *best, const candidate *other) {
    const bool is_first = best->job < 0 && !best->turn;
    if (is_first || other->at_work < best->at_work ||
        (other->at_work == best->at_work && other->place < best->place)) {
        *best = *other;
    }
}

/// Returns whether a job that waits may be begun while `self` (NULL: nobody) is set aside for it.
static bool may_begin(const hn_jobs *jobs, const waiting_job *job, const hn_job_turn *self) {
    if (!self) {
        return true;
    }
    return count_turns(jobs, TURN_ASIDE) < jobs->opts.n_aside &&
           (job->client != self->client ||
            count_of(jobs, TURN_ASIDE, self->client) < jobs->opts.n_aside_of_one);
}

/// Jobs of a client at work without `self` (NULL: with all).
static int count_at_work(const hn_jobs *jobs, hn_client client, const hn_job_turn *self) {
    return count_of(jobs, TURN_AT_WORK, client) - (self && self->client == client);
}

/// The next one, as if `self` (NULL: nobody) were not at work.
static candidate find_next(const hn_jobs *jobs, const hn_job_turn *self) {
    candidate best = {.job = -1};
    for (int i = 0; i < jobs->n; i++) {
        const waiting_job *w = &jobs->waiting[i];
        if (may_begin(jobs, w, self)) {
            const int at_work = count_at_work(jobs, w->client, self);
            consider(&best, &(candidate){.job = i, .at_work = at_work, .place = w->place});
        }
    }
    for (int i = 0; i < jobs->n_threads; i++) {
        hn_job_turn *t = &jobs->turns[i];
        if (t->state == TURN_ASIDE) {
            const int at_work = count_at_work(jobs, t->client, self);
            const candidate other = {.job = -1, .turn = t, .at_work = at_work, .place = t->place};
            consider(&best, &other);
        }
    }
    return best;
}

// ---- threads ----

/// A thread that does nothing; there is one whenever a job may be begun. With the lock held.
static hn_job_turn *find_idle(const hn_jobs *jobs) {
    int i = 0;
    while (jobs->turns[i].state != TURN_IDLE) {
        i++;
        HN_ASSERT(i < jobs->n_threads);
    }
    return &jobs->turns[i];
}

/// Gives a job that waits to a thread. With the lock held.
static void begin(hn_jobs *jobs, int index) {
    hn_job_turn *t = find_idle(jobs);
    t->work = jobs->waiting[index].work;
    t->client = jobs->waiting[index].client;
    t->state = TURN_AT_WORK;
    t->taken_up = hn_clock_wall();
    jobs->n--;
    memmove(&jobs->waiting[index], &jobs->waiting[index + 1],
            (size_t)(jobs->n - index) * sizeof *jobs->waiting);
}

/// Returns false when there is no candidate. With the lock held.
static bool take(hn_jobs *jobs, const candidate *next) {
    if (next->turn) {
        next->turn->state = TURN_AT_WORK;
    } else if (next->job >= 0) {
        begin(jobs, next->job);
    }
    pthread_cond_broadcast(&jobs->changed);
    return next->turn || next->job >= 0;
}

/// Takes up as many as may be at work. With the lock held.
static void take_up(hn_jobs *jobs) {
    bool goes_on = true;
    while (goes_on && count_turns(jobs, TURN_AT_WORK) < jobs->opts.at_once) {
        const candidate next = find_next(jobs, NULL);
        goes_on = take(jobs, &next);
    }
}

static void begin_slice(hn_job_turn *t) {
    t->begun = hn_clock_wall();
    t->look = t->begun + SLICE;
}

/// Does the job that a thread was given. With the lock held, which is given up meanwhile.
static void do_job(hn_jobs *jobs, hn_job_turn *t) {
    pthread_mutex_unlock(&jobs->lock);
    t->used = 0;
    atomic_store(&t->share, 0);
    begin_slice(t);
    jobs->run(t->work, t);
    const double took = t->used + hn_clock_wall() - t->begun;

    pthread_mutex_lock(&jobs->lock);
    jobs->mean += LATEST * (took - jobs->mean);
    t->state = TURN_IDLE;
    take_up(jobs);
}

static void *work(void *arg) {
    hn_job_turn *t = arg;
    hn_jobs *jobs = t->jobs;
    pthread_mutex_lock(&jobs->lock);
    while (t->state == TURN_AT_WORK || !jobs->stopping || jobs->n > 0) {
        if (t->state == TURN_AT_WORK) {
            do_job(jobs, t);
        } else {
            pthread_cond_wait(&jobs->changed, &jobs->lock);
        }
    }
    pthread_mutex_unlock(&jobs->lock);
    return NULL;
}

void hn_job_report(hn_job_turn *t, double share) {
    if (t) {
        atomic_store_explicit(&t->share, share, memory_order_relaxed);
    }
}

void hn_job_make_way(hn_job_turn *t) {
    if (!t || hn_clock_wall() < t->look) {
        return;
    }
    hn_jobs *jobs = t->jobs;
    pthread_mutex_lock(&jobs->lock);
    const candidate next = find_next(jobs, t);
    if (!jobs->stopping && next.at_work <= count_at_work(jobs, t->client, t) && take(jobs, &next)) {
        t->used += hn_clock_wall() - t->begun;
        t->state = TURN_ASIDE;
        t->place = ++jobs->places;
        while (t->state == TURN_ASIDE && !jobs->stopping) {
            pthread_cond_wait(&jobs->changed, &jobs->lock);
        }
        t->state = TURN_AT_WORK; // when the pool stops, at once
        begin_slice(t);
    }
    t->look = hn_clock_wall() + SLICE;
    pthread_mutex_unlock(&jobs->lock);
}

// ---- the pool ----

static bool start_thread(hn_jobs *jobs) {
    hn_job_turn *t = &jobs->turns[jobs->n_threads];
    t->jobs = jobs;
    const bool started = pthread_create(&t->thread, NULL, work, t) == 0;
    jobs->n_threads += started;
    return started;
}

hn_jobs *hn_jobs_create(const hn_jobs_opts *opts, void (*run)(void *job, hn_job_turn *turn)) {
    hn_jobs *jobs = calloc(1, sizeof *jobs);
    if (!jobs) {
        return NULL;
    }
    pthread_mutex_init(&jobs->lock, NULL);
    pthread_cond_init(&jobs->changed, NULL);
    jobs->opts = *opts;
    jobs->run = run;
    const int n = opts->at_once + opts->n_aside;
    jobs->waiting = calloc((size_t)opts->n_waiting, sizeof *jobs->waiting);
    jobs->turns = calloc((size_t)n, sizeof *jobs->turns);

    // a thread looks at nothing here before it has the lock
    pthread_mutex_lock(&jobs->lock);
    while (jobs->waiting && jobs->turns && jobs->n_threads < n && start_thread(jobs)) {}
    pthread_mutex_unlock(&jobs->lock);
    if (jobs->n_threads < n) {
        hn_jobs_free(jobs);
        return NULL;
    }
    return jobs;
}

int hn_jobs_push(hn_jobs *jobs, void *work_item, hn_client client) {
    pthread_mutex_lock(&jobs->lock);
    const int taken = !jobs->stopping && jobs->n < jobs->opts.n_waiting &&
                      (client == 0 || count_waiting(jobs, client) < jobs->opts.n_waiting_of_one);
    if (taken) {
        jobs->waiting[jobs->n++] =
            (waiting_job){.work = work_item, .client = client, .place = ++jobs->places};
        take_up(jobs);
    }
    pthread_mutex_unlock(&jobs->lock);
    return taken;
}

/// Returns the time [s] that a job still needs after it has worked for `used`: by the share of it
/// that is done, where the job reports one. Otherwise what the mean of the jobs before leaves; a
/// job that went on for longer will go on for as long again. At most the longest that a job may.
static double needs_still(const hn_jobs *jobs, const hn_job_turn *t, double used) {
    const double share = atomic_load_explicit(&t->share, memory_order_relaxed);
    const double most = fmax(0, jobs->opts.longest - used);
    if (share > 0) {
        return fmin(used * fmax(0, 1 - share) / share, most);
    }
    return used < jobs->mean ? jobs->mean - used : fmin(used, most);
}

/// When the first of the jobs that are begun ends, which share the threads evenly [s]. With the
/// lock held.
static double time_to_end(const hn_jobs *jobs) {
    const double now = hn_clock_wall();
    const int n = jobs->n_threads - count_turns(jobs, TURN_IDLE);
    const double share = fmin(1, (double)jobs->opts.at_once / (n > 0 ? n : 1));
    double first = HUGE_VAL;
    for (int i = 0; i < jobs->n_threads; i++) {
        const hn_job_turn *t = &jobs->turns[i];
        if (t->state != TURN_IDLE) {
            first = fmin(first, needs_still(jobs, t, (now - t->taken_up) * share) / share);
        }
    }
    return n > 0 ? first : 0;
}

int hn_jobs_wait(hn_jobs *jobs) {
    pthread_mutex_lock(&jobs->lock);
    const double seconds = time_to_end(jobs); // then one that waits is begun, and leaves its place
    pthread_mutex_unlock(&jobs->lock);
    return (int)fmin(60, fmax(1, ceil(seconds)));
}

void hn_jobs_stop(hn_jobs *jobs) {
    if (!jobs) {
        return;
    }
    pthread_mutex_lock(&jobs->lock);
    jobs->stopping = 1;
    const int n = jobs->n_threads;
    pthread_cond_broadcast(&jobs->changed);
    pthread_mutex_unlock(&jobs->lock);
    for (int i = 0; i < n; i++) {
        pthread_join(jobs->turns[i].thread, NULL);
    }

    // who was refused may still ask how long to wait
    pthread_mutex_lock(&jobs->lock);
    jobs->n_threads = 0;
    pthread_mutex_unlock(&jobs->lock);
}

void hn_jobs_free(hn_jobs *jobs) {
    if (jobs) {
        hn_jobs_stop(jobs);
        pthread_cond_destroy(&jobs->changed);
        pthread_mutex_destroy(&jobs->lock);
        free(jobs->waiting);
        free(jobs->turns);
        free(jobs);
    }
}
