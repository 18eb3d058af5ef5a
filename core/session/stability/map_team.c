// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stability/map_team.h"

#include "session/stability/map_grid.h"
#include "session/stability/stability_store.h"

#include "integrators/method/guest.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

enum { MOST_THREADS = 64 };
static const long LOOK_EVERY = 50000000; // [ns] between questions whether to stop

/// One thread: a map like the team's, with a scene of its own; the first has the team's, whose
/// motion the map needs afterwards.
typedef struct member {
    hn_map_team *team;
    hn_map map;
    hn_map_scene scene;
    hn_model *model; ///< owned; NULL: the team's
    pthread_t thread;
} member;

struct hn_map_team {
    hn_map *map;
    int n;
    member *members;

    // the work at hand; what follows the lock is guarded by it
    const int *cells;
    int n_cells;
    atomic_int next;
    atomic_int ending; ///< everybody is to stop
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int *done; ///< cells with an outcome, in the order in which they came
    int n_done, n_busy;
};

// ---- life ----

static int ask_team(void *user) {
    const hn_map_team *team = user;
    return atomic_load(&team->ending);
}

/// A member's map: the team's, but for its scene and whom it asks whether to stop.
static bool add_member(hn_map_team *team) {
    member *m = &team->members[team->n];
    hn_diags ignored = {0}; // where the scene cannot be loaded again, one thread does the work
    const hn_job_request *r = &team->map->request;
    if (team->n > 0 && r->load(r->load_user, NULL, 0, &m->model, &ignored) != HN_OK) {
        return false;
    }
    m->team = team;
    m->map = *team->map;
    if (m->model) {
        m->map.model = m->model;
        m->map.scenes = &m->scene;
    }
    m->map.request.limits.stop = ask_team;
    m->map.request.limits.user = team;
    team->n++;
    return true;
}

/// Returns whether the cells can be shared out: by scenes of one kind, and to methods of this
/// program.
static bool can_share(const hn_map *map) {
    bool own = true;
    for (int m = 0; m < map->n_methods; m++) {
        own = own && !hn_guest_is_named(map->names[m]);
    }
    return own && map->request.load && !map->x.is_param && !map->y.is_param;
}

hn_map_team *hn_map_team_create(hn_map *map) {
    const int wanted = map->request.limits.threads;
    const int threads = wanted < MOST_THREADS ? wanted : MOST_THREADS;
    if (threads < 2 || !can_share(map)) {
        return NULL;
    }

    hn_map_team *team = calloc(1, sizeof *team);
    const size_t cells = (size_t)map->n_methods * (size_t)map->x.n * (size_t)map->y.n;
    if (!team) {
        return NULL;
    }
    team->map = map;
    team->members = calloc((size_t)threads, sizeof *team->members);
    team->done = malloc((cells + 1) * sizeof *team->done);
    pthread_mutex_init(&team->lock, NULL);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC); // a clock that is set moves no wait
    pthread_cond_init(&team->changed, &attributes);
    pthread_condattr_destroy(&attributes);

    // loaded one by one: only what happens in threads needs scenes of its own
    bool made = team->members && team->done;
    for (int i = 0; i < threads && made; i++) {
        made = add_member(team);
    }
    if (!made) {
        hn_map_team_free(team);
        return NULL;
    }
    return team;
}

void hn_map_team_free(hn_map_team *team) {
    if (!team) {
        return;
    }
    for (int i = 0; i < team->n; i++) {
        hn_stability_path_free(team->members[i].scene.path);
        hn_model_free(team->members[i].model);
    }
    pthread_mutex_destroy(&team->lock);
    pthread_cond_destroy(&team->changed);
    free(team->members);
    free(team->done);
    free(team);
}

// ---- work ----

/// Tries one cell and hands it in. Returns false when stopped.
static bool try_cell(member *m, int cell) {
    hn_map_team *team = m->team;
    const int columns = m->map.x.n, rows = m->map.y.n;
    const int column = cell % columns, row = cell / columns % rows, method = cell / columns / rows;
    const hn_method_spec spec = hn_map_spec_at(&m->map, method, column, m->map.y.value[row]);
    hn_stability_trial trial;
    if (!hn_map_try(&m->map, hn_map_scene_of(&m->map, column, row), &spec, &trial)) {
        return false;
    }
    pthread_mutex_lock(&team->lock);
    team->map->cells[cell].trial = trial;
    team->done[team->n_done++] = cell;
    pthread_cond_signal(&team->changed);
    pthread_mutex_unlock(&team->lock);
    return true;
}

static void *work(void *user) {
    member *m = user;
    hn_map_team *team = m->team;
    for (int k; (k = atomic_fetch_add(&team->next, 1)) < team->n_cells;) {
        if (hn_map_must_end(&m->map) || !try_cell(m, team->cells[k])) {
            break;
        }
    }
    pthread_mutex_lock(&team->lock);
    team->n_busy--;
    pthread_cond_signal(&team->changed);
    pthread_mutex_unlock(&team->lock);
    return NULL;
}

/// Waits for something new, a little while at most; with the lock held.
static void wait_a_little(hn_map_team *team) {
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += LOOK_EVERY;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&team->changed, &team->lock, &until);
}

/// Keeps what the members hand in until none of them is busy.
static void keep_results(hn_map_team *team, void (*seen)(hn_map *map)) {
    hn_map *map = team->map;
    int kept = 0;
    pthread_mutex_lock(&team->lock);
    while (team->n_busy > 0 || kept < team->n_done) {
        if (kept == team->n_done) {
            wait_a_little(team);
        }

        // an outcome that was handed in stays as it is: writing it down needs no lock
        const int end = team->n_done;
        pthread_mutex_unlock(&team->lock);
        for (; kept < end; kept++) {
            const int cell = team->done[kept];
            if (map->cells[cell].trial.kind != HN_STABILITY_PENDING) {
                hn_map_keep_cell(map, cell / map->x.n / map->y.n, cell % map->x.n,
                                 cell / map->x.n % map->y.n);
            }
        }
        pthread_mutex_lock(&team->lock);
        seen(map);
        if (team->n_done < team->n_cells && hn_map_must_end(map)) {
            atomic_store(&team->ending, 1);
        }
    }
    pthread_mutex_unlock(&team->lock);
}

bool hn_map_team_try(hn_map_team *team, const int *cells, int n, void (*seen)(hn_map *map)) {
    team->cells = cells;
    team->n_cells = n;
    team->n_done = 0;
    atomic_store(&team->next, 0);
    atomic_store(&team->ending, hn_map_must_end(team->map));

    // members whose thread cannot be made leave their share to the others
    int started = 0;
    pthread_mutex_lock(&team->lock);
    for (int i = 0; i < team->n && i < n; i++) {
        member *m = &team->members[i];
        m->map.started = team->map->started;
        m->map.stopped = m->map.out_of_time = 0;
        if (pthread_create(&m->thread, NULL, work, m) != 0) {
            break;
        }
        started++;
    }
    team->n_busy = started > 0 ? started : 1;
    pthread_mutex_unlock(&team->lock);
    if (started == 0) {
        work(&team->members[0]);
    }

    keep_results(team, seen);
    for (int i = 0; i < started; i++) {
        pthread_join(team->members[i].thread, NULL);
    }
    for (int i = 0; i < team->n; i++) {
        team->map->left_out |= team->members[i].map.left_out;
        team->map->out_of_time |= team->members[i].map.out_of_time;
    }
    return team->n_done == n;
}
