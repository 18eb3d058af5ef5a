// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/hand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// A hand at a distance of one length from its point pulls with so many times the mechanism's
/// weight.
#define STRENGTH 10.0
#define GRAVITY 9.81 // [m/s^2]: in a scene without gravity too

hn_status hn_hand_create(const hn_system *sys, hn_hand *hand) {
    *hand = (hn_hand){.sys = sys};
    if (!hn_system_pulls(sys)) {
        return HN_OK;
    }
    hand->arena = hn_arena_create(0);
    return hand->arena ? hn_pull_force_create(sys, hand->arena, &hand->force) : HN_ERR_MEMORY;
}

void hn_hand_free(hn_hand *hand) {
    hn_pull_force_free(hand->force);
    hn_arena_free(hand->arena);
    free(hand->events);
    *hand = (hn_hand){0};
}

/// The mass of all bodies; of formulas 1 kg, since they do not say.
static double mass_of(const hn_scene *scene) {
    double mass = 0;
    for (int i = 0; i < scene->n_bodies; i++) {
        mass += scene->bodies[i].mass.value;
    }
    return mass > 0 ? mass : 1;
}

/// The nearest number of three decimal digits: nobody chooses a hand more finely, and a log of it
/// stays short. 0, and what a power of ten cannot scale, stays.
static double round_digits(double x) {
    if (!(x > 1e-200 && x < 1e200)) {
        return x;
    }
    const int places = 2 - (int)floor(log10(x));
    const double scale = pow(10, abs(places));
    return places >= 0 ? round(x * scale) / scale : round(x / scale) * scale;
}

void hn_pull_choose_spring(const hn_system *sys, hn_pull *pull) {
    const double mass = mass_of(hn_system_scene(sys));
    if (pull->stiffness < 0) {
        pull->stiffness = round_digits(STRENGTH * mass * GRAVITY / hn_system_length(sys));
    }
    if (pull->damping < 0) {
        pull->damping = round_digits(sqrt(pull->stiffness * mass));
    }
}

static hn_status check(const hn_hand *hand, const hn_pull *pull, hn_diag *diag) {
    const hn_pull_log *log = hn_system_pulls(hand->sys);
    if (!log || hn_pull_log_find(log, pull->point) < 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/pull/point", NULL,
                           "point %d cannot be pulled in this comparison", pull->point);
    }
    const double values[] = {pull->to[0], pull->to[1], pull->to[2], pull->stiffness, pull->damping};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        if (!(fabs(values[i]) <= HN_SCENE_MAX_NUMBER)) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/pull/to", NULL,
                               "a number of the pull is not finite or above 1e100 in size");
        }
    }
    return HN_OK;
}

static hn_status make_room(hn_hand *hand) {
    if (hand->n < hand->cap) {
        return HN_OK;
    }
    const int cap = hand->cap ? 2 * hand->cap : 64;
    hn_pull_event *grown = realloc(hand->events, (size_t)cap * sizeof *grown);
    if (!grown) {
        return HN_ERR_MEMORY;
    }
    hand->events = grown;
    hand->cap = cap;
    return HN_OK;
}

hn_status hn_hand_add(hn_hand *hand, long long frame, hn_pull *pull, hn_diag *diag) {
    HN_TRY(check(hand, pull, diag));
    hn_pull_choose_spring(hand->sys, pull);
    hand->n = hand->done;
    if (hand->n > 0 && hand->events[hand->n - 1].frame > frame) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/pulls", NULL, "pulls must be in order of frames");
    }
    if (hand->n == HN_PULL_MOST_ENTRIES) {
        return hn_diag_set(diag, HN_ERR_LIMIT, "/pull",
                           "reset the comparison and leave its pulls out",
                           "this comparison already has %d pulls, which is the largest number",
                           HN_PULL_MOST_ENTRIES);
    }
    if (make_room(hand) != HN_OK) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    hand->events[hand->n++] = (hn_pull_event){frame, *pull};
    return HN_OK;
}

void hn_hand_rewind(hn_hand *hand) {
    hand->done = 0;
    if (hn_system_pulls(hand->sys)) {
        hn_pull_log_clear(hn_system_pulls(hand->sys));
    }
}

bool hn_hand_is_due(const hn_hand *hand, long long frame) {
    return hand->done < hand->n && hand->events[hand->done].frame <= frame;
}

void hn_hand_do(hn_hand *hand, long long frame, double t) {
    hn_pull_log *log = hn_system_pulls(hand->sys);
    while (hn_hand_is_due(hand, frame) &&
           hn_pull_log_add(log, t, &hand->events[hand->done].pull) == HN_OK) {
        hand->done++;
    }
}

void hn_hand_put_json(hn_strbuf *b, const hn_hand *hand, double t) {
    const hn_pull_log *log = hn_system_pulls(hand->sys);
    const hn_pull *held = log ? hn_pull_log_at(log, t) : NULL;
    hn_json_key(b, "pull");
    if (!held) {
        hn_json_null(b);
        return;
    }
    hn_json_object(b);
    hn_json_put_int(b, "point", held->point);
    hn_json_put_numbers(b, "to", held->to, 3);
    hn_json_put_number(b, "stiffness", held->stiffness);
    hn_json_put_number(b, "damping", held->damping);
    hn_json_end_object(b);
}

void hn_pull_event_json(hn_strbuf *b, const hn_pull_event *event) {
    const hn_pull *p = &event->pull;
    hn_json_array(b);
    hn_json_int(b, event->frame);
    hn_json_int(b, p->point);
    for (int i = 0; i < 3; i++) {
        hn_json_number(b, p->to[i]);
    }
    hn_json_number(b, p->stiffness);
    hn_json_number(b, p->damping);
    hn_json_end_array(b);
}
