#ifndef HN_DYNAMICS_ASSEMBLE_INTERNAL_H
#define HN_DYNAMICS_ASSEMBLE_INTERNAL_H
// Shared by the parts of assembly: assemble.c (outline, velocity, report), assemble_position.c (the
// search for a closed pose), assemble_explain.c (why there is none), mode.c.

#include "dynamics/assembly/assemble.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/qr.h"

#include <stdint.h>

/// One assembly at work. The search runs in USER coordinates x, because pins are user coordinates,
/// made comparable: z = x / reach (1 rad, or the characteristic length), residual r = phi / L in
/// length rows, phi elsewhere.
typedef struct hn_assembler {
    const hn_system *sys;
    const hn_scene *scene;
    hn_arena *arena;
    hn_diags *diags;
    double t;
    int n, nq, nc; ///< user coordinates (= nv), system positions, constraint rows
    double length;

    hn_eval *eval; ///< M, phi, phi_t, J, energy
    /// user coordinates, their start, system coordinates, speeds of zero
    double *x, *guess, *q, *rest;
    int *turn;              ///< n: 0, 1, 2 for the entries of a rotation vector, else -1
    double *reach;          ///< n
    double *row_scale;      ///< nc
    int n_free, *free;      ///< user coordinates that may move
    double *residual, size; ///< scaled phi (nc) and its length

    // column k of T^-1: rates of the system coordinates for a unit rate of user coordinate k,
    // nonzeros only
    int *map_start, *map_row;
    double *map_value;

    int iterations;
    const char *route;
} hn_assembler;

/// Searches from s->x, pins held, and leaves the best pose found in s->x, s->q, s->residual,
/// s->size. HN_OK: closed; HN_ERR_UNREACHABLE; HN_ERR_DIVERGED: phi is not finite at the guess;
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_position(hn_assembler *s);
/// Goes to the assembly mode that the scene asks for, from a closed pose in s->x.
/// HN_ERR_UNREACHABLE, told, when it is not found: s->x is then as it was. HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_mode(hn_assembler *s);
/// One descent from s->x, as often as wanted; 1 when it closed.
typedef struct hn_assemble_search hn_assemble_search;
HN_MUST_CHECK hn_status hn_assemble_search_create(hn_assembler *s, hn_assemble_search **out);
int hn_assemble_descend(hn_assemble_search *w);
double hn_assemble_random(uint64_t *seed); ///< in [-1, 1), the same on every machine
/// Evaluates at s->x: q, residual, size. 0 when phi is not finite (size is then HUGE_VAL).
int hn_assemble_evaluate(hn_assembler *s);
/// x moved by `delta` (n, user rates times time): a sum, and for orientations the turn by that much
/// in the child's axes.
void hn_assemble_move(const hn_assembler *s, double *x, const double *delta);
/// How far user coordinate i is from its guess; of an orientation, the angle of the turn between
/// them.
double hn_assemble_moved(const hn_assembler *s, int i);
/// Row i of J in user rates, out (n).
void hn_assemble_user_row(const hn_assembler *s, int row, double *out);
/// Euclidean norm of the unscaled phi, over all rows (loop < 0) or those of one loop.
double hn_assemble_gap(const hn_assembler *s, int loop);
/// The first loop that is closed at s->x the wrong way round, or -1: its rows hold as well with the
/// axis (or the reference direction) of one half opposed to the other's, which is another
/// mechanism. Loops whose axes cannot tilt are taken as they are.
int hn_assemble_flipped(const hn_assembler *s);
/// Says why loop `loop` stays open at s->x.
void hn_assemble_explain(hn_assembler *s, int loop);

/// *out = 1: the first loop is a planar four-bar (two rows, three angles, every axis of the ring in
/// the same sense), so that "open" and "crossed" mean something. Scratch from `arena`. Fails:
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_mode_is_four_bar(const hn_system *sys, hn_arena *arena, int *out);
/// The user coordinates of loop `loop` that depend on the others (room for 6); returns their
/// number. Scratch from `arena`.
HN_MUST_CHECK hn_status hn_mode_dependent(const hn_system *sys, hn_arena *arena, int loop,
                                          int *dependent, int *n);
int hn_mode_sign(double value); ///< +1, -1, or 0 within rounding

#endif
