// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/jobs.h"

#include "base/clock.h"
#include "http/ground/promises.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/// Weight of the latest job in the mean duration.
static const double LATEST = 0.2;
/// A job works for so long before it makes way [s].
static const double SLICE = 0.2;
/// A job that goes on for so many times the mean is none of the usual ones.
static const double UNUSUAL = 4;
/// What is told to who is refused, over what is expected.
static const double MARGIN = 1.1;

typedef enum turn_state { TURN_IDLE, TURN_AT_WORK, TURN_ASIDE } turn_state;

struct hn_job_turn {
    hn_jobs *jobs;
    pthread_t thread;
    turn_state state; ///< under the lock, as are `work`, `client` and `place`
    void *work;
    hn_client client;
    long long place;      ///< in the order of those that wait, while it is aside
    double look;          ///< it asks the pool then; of its own thread [s, wall clock]
    double begun;         ///< of its present slice; written under the lock [s, wall clock]
    double used;          ///< by its slices before; likewise [s]
    double cpu_before;    ///< of its thread when the job was begun; likewise [s]
    _Atomic double share; ///< of its present job that is done, 0 to 1; 0: it says nothing
    _Atomic double first_share, worked_before; ///< at its first report; and time worked [s]
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
    double *ends;     ///< for an estimate: when each job that is begun ends [s]
    hn_promises promises;
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

/// Returns the computing time of a thread of the pool [s].
static double thread_time(const hn_job_turn *t) {
    clockid_t clock;
    struct timespec now = {0};
    if (pthread_getcpuclockid(t->thread, &clock) == 0) {
        clock_gettime(clock, &now);
    }
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

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
    t->used = 0;
    t->begun = hn_clock_wall();
    t->cpu_before = thread_time(t);
    atomic_store(&t->share, 0);
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
    begin_slice(t);
    pthread_mutex_unlock(&jobs->lock);
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
    if (!t) {
        return;
    }
    if (share > 0 && atomic_load_explicit(&t->share, memory_order_relaxed) <= 0) {
        atomic_store(&t->first_share, share);
        atomic_store(&t->worked_before, t->used + hn_clock_wall() - t->begun);
    }
    atomic_store_explicit(&t->share, share, memory_order_release);
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
    jobs->ends = calloc((size_t)n, sizeof *jobs->ends);

    // a thread looks at nothing here before it has the lock
    pthread_mutex_lock(&jobs->lock);
    const bool has_memory = jobs->waiting && jobs->turns && jobs->ends;
    while (has_memory && jobs->n_threads < n && start_thread(jobs)) {}
    pthread_mutex_unlock(&jobs->lock);
    if (jobs->n_threads < n) {
        hn_jobs_free(jobs);
        return NULL;
    }
    return jobs;
}

int hn_jobs_push(hn_jobs *jobs, void *work_item, hn_client client, uint64_t key) {
    pthread_mutex_lock(&jobs->lock);
    const int taken = !jobs->stopping && jobs->n < jobs->opts.n_waiting &&
                      (client == 0 || count_waiting(jobs, client) < jobs->opts.n_waiting_of_one);
    if (taken) {
        jobs->waiting[jobs->n++] =
            (waiting_job){.work = work_item, .client = client, .place = ++jobs->places};
        hn_promises_end(&jobs->promises, key);
        take_up(jobs);
    }
    pthread_mutex_unlock(&jobs->lock);
    return taken;
}

// ---- when there will be a place; with the lock held ----

/// Returns how long a job has worked, without the time that it was aside [s].
static double worked(const hn_job_turn *t, double now) {
    return t->used + (t->state == TURN_AT_WORK ? now - t->begun : 0);
}

/// Returns the computing time that a second of work is, over all jobs that are begun: less than 1
/// where the processors have other work too.
static double computing_rate(const hn_jobs *jobs, double now) {
    static const double enough = 0.05, least = 0.02;
    double time = 0, cpu = 0;
    for (int i = 0; i < jobs->n_threads; i++) {
        const hn_job_turn *t = &jobs->turns[i];
        if (t->state != TURN_IDLE) {
            time += worked(t, now);
            cpu += thread_time(t) - t->cpu_before;
        }
    }
    return time > enough ? fmin(1, fmax(least, cpu / time)) : 1;
}

/// Returns the work that a job still needs [s]: by the share of it that is done, where the job
/// reports one. Otherwise what the mean of the jobs before leaves; a job that went on for longer
/// will go on for as long again, or for as long as it may where it should have reported by now.
static double needs_still(const hn_jobs *jobs, const hn_job_turn *t, double now, double rate) {
    const double share = atomic_load_explicit(&t->share, memory_order_acquire);
    const double first = atomic_load(&t->first_share), time = worked(t, now);
    const double counted = share > 0            ? fmax(0, time - atomic_load(&t->worked_before))
                           : jobs->opts.reports ? 0
                                                : time;
    const double most = fmax(0, jobs->opts.longest / rate - counted);
    if (share > 0 && share > first) {
        return fmin(counted * fmax(0, 1 - share) / (share - first), most);
    }
    if (time < jobs->mean) {
        return fmin(jobs->mean - time, most);
    }
    return jobs->opts.reports && time >= UNUSUAL * jobs->mean ? most : fmin(time, most);
}

/// Returns how many jobs may yet be set aside: one that waits is then begun, and leaves its place.
static int room_aside(const hn_jobs *jobs, hn_client client) {
    const int in_all = jobs->opts.n_aside - count_turns(jobs, TURN_ASIDE);
    const int own = jobs->opts.n_aside_of_one - count_of(jobs, TURN_ASIDE, client);
    const bool is_alone = count_of(jobs, TURN_AT_WORK, client) == count_turns(jobs, TURN_AT_WORK);
    const int room = is_alone && own < in_all ? own : in_all;
    return room > 0 ? room : 0;
}

/// Returns when `ahead` + 1 jobs that wait have left their places [s]. Those that are begun share
/// the threads evenly; whatever is begun later lasts as long as they do on average.
static double time_to_place(const hn_jobs *jobs, int ahead, int room) {
    const double now = hn_clock_wall(), rate = computing_rate(jobs, now);
    const int begun = jobs->n_threads - count_turns(jobs, TURN_IDLE), n = begun + room;
    if (begun == 0 || ahead < room) {
        return begun == 0 ? 0 : SLICE * (1 + ahead / jobs->opts.at_once);
    }
    const double share = fmin(1, (double)jobs->opts.at_once / n);
    double whole = 0;
    int k = 0;
    for (int i = 0; i < jobs->n_threads; i++) {
        const hn_job_turn *t = &jobs->turns[i];
        if (t->state != TURN_IDLE) {
            const double need = needs_still(jobs, t, now, rate);
            whole += (worked(t, now) + need) / begun;
            jobs->ends[k++] = need / share;
        }
    }
    for (; k < n; k++) {
        jobs->ends[k] = SLICE + whole / share;
    }

    // the one that ends first gives its thread to the next, again and again
    for (int left = ahead - room;; left--) {
        int first = 0;
        for (int i = 1; i < n; i++) {
            first = jobs->ends[i] < jobs->ends[first] ? i : first;
        }
        if (left == 0) {
            return jobs->ends[first];
        }
        jobs->ends[first] += whole / share;
    }
}

/// Returns how many clients have jobs that wait.
static int count_clients(const hn_jobs *jobs) {
    int n = 0;
    for (int i = 0; i < jobs->n; i++) {
        int k = 0;
        while (jobs->waiting[k].client != jobs->waiting[i].client) {
            k++;
        }
        n += k == i;
    }
    return n;
}

int hn_jobs_wait(hn_jobs *jobs, hn_client client, uint64_t key) {
    static const double longest = 3600;
    pthread_mutex_lock(&jobs->lock);
    const double now = hn_clock_wall();
    const bool is_full = jobs->n >= jobs->opts.n_waiting;
    int ahead = hn_promises_ahead(&jobs->promises, is_full ? NULL : &client, key, now);
    if (!is_full) { // its own jobs must leave their places, and those of others take their turns
        const int clients = count_clients(jobs);
        ahead = (ahead + 1) * (clients > 0 ? clients : 1) - 1;
    }
    const int room = room_aside(jobs, client);
    const double seconds = time_to_place(jobs, ahead, room);
    const double told = fmin(longest, fmax(1, ceil(MARGIN * seconds)));
    hn_promises_make(&jobs->promises, client, key, now + told);
    pthread_mutex_unlock(&jobs->lock);
    return (int)told;
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
        free(jobs->ends);
        free(jobs);
    }
}
