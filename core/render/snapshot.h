// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_H
#define HN_RENDER_SNAPSHOT_H
// Draws a mechanism in the poses of several methods at one time, as one picture:
//
//   title                                   t = 0.500 s
//   caption                              +--------------+
//        ___                             | tear at C    |
//       o   \__o                         |  o---*   x20 |
//      /        \                        +--------------+
//     o          o                       --*-- raw
//    ////       ////                           gap 4.2 mm
//    |-----| 200 mm                      - - - projection
//
// The selected method is opaque. The others are at 60 %, outlined with their dash; the reference
// solution is thin grey beneath. Springs, dampers, sliders and loads look as in textbooks. The
// inset magnifies the widest gap at a cut joint; a gap wide enough to be seen is also drawn in
// place.
//
// The view is opts.look (the front: world x to the right, y up; any other shows a triad of axes).
// It is fitted once to opts.view, so that a series of pictures does not jump.

#include "dynamics/compile/drawing.h"
#include "render/canvas.h"
#include "render/view.h"

#include <stdbool.h>

typedef struct hn_snapshot_pose {
    /// 3 per point of the drawing, world [m]; NULL: the method has no pose and is only listed
    const double *points;
    const char *name; ///< for the legend
    const char *note; ///< "gap 4.2 mm", "stopped at 1.2 s: diverged", or NULL
    int slot;         ///< hn_look slot; HN_LOOK_REFERENCE: the reference solution
    int selected;     ///< opaque and on top; where no pose is, the first one is
    bool faint;       ///< an earlier pose of a method: pale, with its time beside it
    double time;      ///< [s] of a faint pose
    /// n_trace world points that were passed (3 each; NaN: a new line begins), or NULL
    const double *trace;
    int n_trace; ///< for opts.n_traces paths of equal numbers of points, one after another
} hn_snapshot_pose;

/// A force drawn at a point of the selected pose. Arrows of the drawing have neither size nor
/// direction of their own: they are drawn from these.
typedef struct hn_snapshot_load {
    int point;        ///< of the drawing; -1: at `place`
    double place[3];  ///< [m], world
    double force[3];  ///< [unit]
    const char *unit; ///< "N"
    const char *name; ///< of the joint; NULL: it is not written
} hn_snapshot_load;

/// The angle of a coordinate, drawn at a pivot of the selected pose: an arc in the world, seen as
/// the view shows it.
typedef struct hn_snapshot_angle {
    int pivot, end;    ///< points of the drawing: the bar that the coordinate turns
    double zero[3];    ///< unit, world: where the bar lies at 0
    double quarter[3]; ///< unit, world: where the bar lies at pi/2
    double value;      ///< [rad] by which the bar has turned
    const char *name;
} hn_snapshot_angle;

typedef struct hn_snapshot_opts {
    const char *title, *caption; ///< may be NULL
    double time;                 ///< [s]; NaN: not shown
    bool stopped;                ///< the motion has ended at that time, before the one asked for
    hn_view look;                ///< direction of view
    /// right0, right1, up0, up1 [m] to fit; right1 <= right0: fitted to the poses given
    double view[4];
    int n_loads;
    const hn_snapshot_load *loads;
    double longest_load; ///< [unit] what the longest arrow stands for; 0: the largest of `loads`
    bool labels;         ///< points with a name show it
    bool dimensions;     ///< bars of the selected pose show their lengths
    int n_angles;
    const hn_snapshot_angle *angles;
    int n_traces;
    const char *const *traces; ///< the names of the points whose paths the poses carry
    /// a later panel of a strip: the first has said title, names and keys
    bool continued;
    bool bare; ///< the drawing and its scale bar alone: no words, legend or inset
} hn_snapshot_opts;
/// no texts, no loads, labels on, from the front, fitted to the poses
hn_snapshot_opts hn_snapshot_opts_default(void);

/// Draws on a fresh canvas. A pose with a point that is not finite is listed but not drawn. Fails
/// with HN_ERR_INPUT when no pose can be drawn; faults of the canvas itself show when it is
/// painted.
HN_MUST_CHECK hn_status hn_snapshot_draw(hn_canvas *c, const hn_drawing *drawing,
                                         const hn_snapshot_pose *poses, int n_poses,
                                         const hn_snapshot_opts *opts, hn_diag *diag);

/// The map from the plane of the view to the picture: pixel (x + scale right, y - scale up).
typedef struct hn_snapshot_place {
    double scale; ///< [px/m]
    double x, y;  ///< [px] of the world's origin
    double size;  ///< [px] the larger of the width and the height of what is shown
} hn_snapshot_place;
/// The same arguments as hn_snapshot_draw(), and its failures.
HN_MUST_CHECK hn_status hn_snapshot_find_place(hn_snapshot_place *out, int width, int height,
                                               const hn_drawing *drawing,
                                               const hn_snapshot_pose *poses, int n_poses,
                                               const hn_snapshot_opts *opts, hn_diag *diag);

/// Describes the content of the picture, for readers who cannot see it and for tests:
/// {"view","metres_per_pixel","poses":[{"name","slot","drawn","selected","note"}],
/// "tears":[{"name","pose","gap"}],"inset":null or {"tear","pose","gap","magnification"},
/// "scale_bar","time","stopped","mechanism_pixels","labels","hatching","listed","legend",
/// "force_scale", primitives and marks}. The same arguments as hn_snapshot_draw().
HN_MUST_CHECK hn_status hn_snapshot_describe(hn_strbuf *b, int width, int height,
                                             const hn_drawing *drawing,
                                             const hn_snapshot_pose *poses, int n_poses,
                                             const hn_snapshot_opts *opts, hn_diag *diag);

#endif
