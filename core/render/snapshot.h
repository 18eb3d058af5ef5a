#ifndef HN_RENDER_SNAPSHOT_H
#define HN_RENDER_SNAPSHOT_H
// A mechanism in the poses of several methods at one time, as one picture:
//
//   title                                   t = 0.500 s        The selected method is opaque; the others are ghosts at
//   caption                              +--------------+      60 %, outlined with their dash; the reference solution is
//        ___                             | tear at C    |      thin grey beneath. Springs, dampers, sliders, loads as
//       o   \__o                         |  o---*   x20 |      textbooks draw them. The inset shows the widest tear at a
//      /        \                        +--------------+      cut joint, magnified; where a tear is wide enough it is
//     o          o                       --*-- raw             seen in place too.
//    ////       ////                           gap 4.2 mm
//    |-----| 200 mm                      - - - projection
//
// Seen from opts.look (the front: world x to the right, y up; else a triad tells); fitted once to opts.view, so that a series
// does not jump.

#include "dynamics/compile/drawing.h"
#include "render/canvas.h"
#include "render/view.h"

typedef struct hn_snapshot_pose {
    const double *
        points; ///< 3 per point of the drawing, world [m]; NULL: the method has no pose and is only listed
    const char *name; ///< for the legend
    const char *note; ///< "gap 4.2 mm", "stopped at 1.2 s: diverged", or NULL
    int slot;         ///< hn_look slot; HN_LOOK_REFERENCE: the reference solution
    int selected;     ///< opaque and on top; where no pose is, the first one is
    const double
        *trace; ///< n_trace world points that were passed (3 each; NaN: a new line begins), or NULL
    int n_trace;
} hn_snapshot_pose;

/// A force drawn at a point of the selected pose. Arrows of the drawing have neither size nor direction of their own:
/// they are drawn from these.
typedef struct hn_snapshot_load {
    int point;        ///< of the drawing
    double force[3];  ///< [unit]
    const char *unit; ///< "N"
} hn_snapshot_load;

typedef struct hn_snapshot_opts {
    const char *title, *caption; ///< may be NULL
    double time;                 ///< [s]; NaN: not shown
    hn_view look;                ///< where one looks from
    double view
        [4]; ///< right0, right1, up0, up1 [m] to fit; right1 <= right0: fitted to the poses given
    int n_loads;
    const hn_snapshot_load *loads;
    int labels; ///< 1: points with a name show it
} hn_snapshot_opts;
hn_snapshot_opts hn_snapshot_opts_default(
    void); ///< no texts, no loads, labels on, from the front, fitted to the poses

/// Draws on a fresh canvas. A pose with a point that is not finite is listed but not drawn. Fails with HN_ERR_INPUT when
/// no pose can be drawn; faults of the canvas itself show when it is painted.
HN_MUST_CHECK hn_status hn_snapshot_draw(hn_canvas *c, const hn_drawing *drawing,
                                         const hn_snapshot_pose *poses, int n_poses,
                                         const hn_snapshot_opts *opts, hn_diag *diag);

/// What the picture shows, for readers who cannot see it and for tests: {"view","metres_per_pixel","poses":[{"name",
/// "slot","drawn","selected","note"}],"tears":[{"name","pose","gap"}],"inset":null or {"tear","pose","gap",
/// "magnification"},"scale_bar"}. The same arguments as hn_snapshot_draw().
HN_MUST_CHECK hn_status hn_snapshot_describe(hn_strbuf *b, int width, int height,
                                             const hn_drawing *drawing,
                                             const hn_snapshot_pose *poses, int n_poses,
                                             const hn_snapshot_opts *opts, hn_diag *diag);

#endif
