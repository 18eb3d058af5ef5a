// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_RECORDING_H
#define HN_TUI_RECORDING_H
// A comparison that is recorded: a thread steps it ahead of the viewer, every frame is kept, and
// nothing is computed twice.
//
//   worker thread:  stored reference -> frame 0, 1, 2 ... up to the wanted one -> waits
//   viewer:         wants a frame; reads frames below hn_recording_frames(), which never change

#include "session/compare/comparison.h"
#include "session/verdict/verdict.h"

#include <stdbool.h>

typedef struct hn_recording hn_recording;

/// One method over all frames. Numbers at frames below hn_recording_frames() are final, errors
/// apart; NaN: the method had ended.
typedef struct hn_track {
    char spelling[HN_SPEC_MAX];
    const char *name, *rule; ///< short name, sentence on its drift; static
    int slot;                ///< colour and glyph (render/look.h)
    bool model_error;        ///< a counter-example: it solves other equations
    const double *gap, *velocity_gap;
    const double *energy; ///< change since the start [J]
    /// largest distance of a drawn point from the reference [m]; NaN: no reference there, and at
    /// frame 0 (hn_recording_update)
    const double *error;
    const double *points;   ///< 3 n_points a frame
    const double *q, *v;    ///< n_user a frame: coordinates and rates as in the scene
    const double *step_ops; ///< operations of a step on average; NaN: not counted, or no step yet
} hn_track;

/// Ending of a method, as far as it is known now.
typedef struct hn_track_end {
    bool failed;
    double t;                       ///< [s] reached
    double worst_gap, worst_energy; ///< of its steps, those between frames too [m], [J]
    const char *cause;              ///< what ended it, in a few words; static; NULL: not known
    char reason[480];
} hn_track_end;

/// Starts recording the scene's duration; the model must outlive it. limit: of computing time [s],
/// after which no frame follows; 0: none. Faults of a spelling are in diags ("/methods/2").
HN_MUST_CHECK hn_status hn_recording_create(const hn_model *model, const char *const *methods,
                                            int n_methods, double limit, hn_recording **out,
                                            hn_diags *diags);
/// Stops the thread within the frame that it is at, and frees all.
void hn_recording_free(hn_recording *r);

/// Asks for all frames up to this one.
void hn_recording_want(hn_recording *r, int frame);
int hn_recording_frames(const hn_recording *r);      ///< recorded so far, at least 1
double hn_recording_computed(const hn_recording *r); ///< computing time of its frames so far [s]
bool hn_recording_is_out_of_time(const hn_recording *r); ///< its limit ended it before its end
int hn_recording_last(const hn_recording *r);            ///< index of the frame at the duration
double hn_recording_frame_dt(const hn_recording *r);     ///< [s]
double hn_recording_duration(const hn_recording *r);     ///< [s]
/// The time of a frame; the last one may begin within the duration and reach beyond: it counts as
/// the end [s].
double hn_recording_time(const hn_recording *r, int frame);
/// The number that the page gives to the same moment.
int hn_recording_page_frame(const hn_recording *r, int frame);
const hn_track *hn_recording_track(const hn_recording *r, int i);
hn_track_end hn_recording_end(const hn_recording *r, int i);
/// Takes the errors of the frames recorded since the last call, all of them when the reference has
/// come. For the thread that reads; tracks show errors up to here.
void hn_recording_update(hn_recording *r);
/// Returns whether no reference is stored for these parameters, and none is being computed.
bool hn_recording_needs_reference(const hn_recording *r);
/// Starts computing the reference on a thread of its own; `model` is the same model once more, and
/// is taken. false: the system gives no thread.
bool hn_recording_compute_reference(hn_recording *r, hn_model *model);
bool hn_recording_is_asking(const hn_recording *r); ///< a reference is fetched or computed
enum { HN_RECORDING_WHY = 320 };
/// Why no reference could be computed; "" where it is not known, or there is one.
void hn_recording_why_unknown(const hn_recording *r, char out[HN_RECORDING_WHY]);
/// Points of the reference motion at a frame (3 n_points); NULL: none.
const double *hn_recording_reference(const hn_recording *r, int frame);
/// Incidents of all methods so far, copied: at most `most`; method[i] is whose. Returns how many.
int hn_recording_incidents(const hn_recording *r, hn_incident *out, int *method, int most);
/// The verdict on a method at a frame that is recorded.
hn_motion_verdict hn_recording_verdict(const hn_recording *r, int track, int frame);
/// Seconds of wall time that the last frame took; above frame_dt the methods are slower than the
/// clock.
double hn_recording_frame_seconds(const hn_recording *r);
#endif
