/* The formulas of the arm: forward.c for given joints, inverse.c for a given pose; stand.c for a
   position alone, and search.c, both for the search for joint paths; and tour.c for the order.

   Plain C, one configuration at a time; module.c offers them to Python, for one and for many.

   Joints 2, 3 and 4 move the arm in a vertical plane, which joint 1 turns about the base's z axis
   to the azimuth phi. A point of that plane is (r, z): its signed distance from joint 1's axis,
   negative over the arm's back, and its height, in m. In the plane the upper arm leans from the
   vertical by t2, the forearm by t23 and the tool by beta, its pitch; joint 5 rolls it by gamma:

       phi = OFFSET_1 - q1    t2 = q2 + OFFSET_2    t23 = t2 + q3 + OFFSET_3
       beta = t23 + q4 + OFFSET_4    gamma = -OFFSET_5 - q5

   The product of the arm's Denavit-Hartenberg transforms comes down to these angles, for
   Rz(phi) turns the plane, and in it all rotations are about one axis, its normal.

   Units: m and rad. Poses are homogeneous transforms in base_link. */
#ifndef YOUBOT_FORMULAS_H
#define YOUBOT_FORMULAS_H

#include <stdbool.h>
#include <stdint.h>

#define PI 3.14159265358979323846 /* which C99 does not define */

enum { JOINTS = 5, FRAMES = JOINTS + 1, BRANCHES = 4 };

typedef double Joints[JOINTS];
typedef double Pose[4][4];
typedef struct { double r, z; } Point;

/* The Denavit-Hartenberg table and the joints' zeros: module.c has them from arm.py. */
typedef struct { Joints offset, a, d; } Arm;
extern Arm arm;

typedef struct { Joints lower, upper; } Limits;

/* A joint this little outside of its limit, by rounding, is on the limit, rad. */
#define LIMIT_ROUNDING 1e-9
/* How far a pose may be tilted out of the arm's plane and still count as asked for exactly, rad. */
#define POSE_TOLERANCE 1e-9
/* A position counts as in a plane, or on joint 1's axis, that it is this near to, m. */
#define ON_PLANE 1e-9
/* How far R^T R may be off the identity, and the last row off 0 0 0 1, in a pose. */
#define ROTATION_TOLERANCE 1e-6
#define LAST_ROW_TOLERANCE 1e-9

/* --- forward.c --- */

/* The pose of the tool. */
void tool_pose(const Joints q, Pose T);
/* The base and the five Denavit-Hartenberg frames, the last one being the tool's. */
void dh_frames(const Joints q, Pose T[FRAMES]);
/* The geometric Jacobian of the tool: linear (m/rad) over angular velocity (rad/rad). */
void jacobian(const Joints q, double J[6][JOINTS]);
/* The smallest singular value of that, from its two blocks: see singularity.py. */
double smallest_singular_value(const Joints q);

/* --- inverse.c --- */

/* The whole answer for one pose, a row for each branch: see Branches of inverse.py. */
typedef struct {
    Joints joints[BRANCHES];
    bool valid[BRANCHES];
    double out_of_reach[BRANCHES];
    Joints limit_excess[BRANCHES];
    double tilt[BRANCHES];
} Answer;

/* q1: joint 1 where the pose leaves it free. */
void solve(const Pose T, const Limits *limits, double q1, Answer *answer);
/* Azimuth of the plane of an arm that reaches forward to the pose T. */
double front_azimuth(const Pose T, const Limits *limits, double q1);

/* Joints 2, 3 and 4 of an arm whose tool is at a point of its plane with a pitch: elbow + and -,
   not turned into the limits. Returns by how much the wrist is out of reach: see two_links. */
double bend(Point tool, double pitch, double joints[2][3]);
/* Two links in a plane: shoulder angle a and elbow angle b (rad, from the x axis) that bring their
   end to (x, y), with b >= 0 and with b <= 0. Returns how far the point is beyond the stretched arm
   (> 0) or within the folded one (< 0), which the links then are; 0 if it is reached. */
double two_links(double x, double y, double l1, double l2, double a[2], double b[2]);

/* An angle turned by whole turns to where it is next to its range; one that is outside by no more
   than LIMIT_ROUNDING is set on the limit. What is beyond goes to excess: 0 inside. */
double turned(double angle, double lower, double upper, double *excess);

/* What keeps a pose from being a rigid transform. */
typedef struct {
    bool finite, left_handed;
    double rotation_error; /* R^T R is off the identity by this at most */
    double last_row_error; /* the last row is off 0 0 0 1 */
} Flaws;
Flaws flaws(const Pose T);
bool is_rigid(const Pose T);

/* --- stand.c --- */

enum { STAND_JOINTS = 4 }; /* joint 5 turns the tool in its place */

/* A place of the tool: where it is in the plane of an arm that reaches forward to it, at an azimuth,
   and how far joints keep from their limits there, rad. */
typedef struct { double azimuth; Point point; double margin; } Place;

/* Joints 1 to 4 with the elbow + and -, on a track (0 front, 1 back), turned next to their limits;
   and by how much each passes them, less the margin: NaN where the wrist is out of reach. */
void stand(const Place *place, int track, double pitch, const Limits *limits,
           double joints[2][STAND_JOINTS], double excess[2][STAND_JOINTS]);
/* A cell of a waypoint: joints 1 to 4 over their velocities, in s, NaN where the arm cannot stand.
   A waypoint has BRANCHES x n_cells of them, numbered branch * n_cells + pitch. */
typedef float Cell[STAND_JOINTS];

/* The cells of a place, and the pitch in each of them. So many pitches, an odd number, are tried in
   a cell, from its middle outwards, until one is valid. */
void standings(const Place *place, const double *pitches, int n_cells, int finer,
               const Limits *limits, const Joints velocity, Cell *cells, float *pitch);

/* --- search.c --- */

/* The least cost (s) of each cell of a waypoint, given those of the cells before, and the cell that
   it comes from: by steps on one branch, to no more than `reach` pitches on round the circle, in
   which no joint moves for longer than the tear (s). INFINITY where there is none. */
void smooth_step(const Cell *before, const Cell *after, const double *cost, int n_pitches,
                 int reach, float tear, double *total, int16_t *origin);
/* The same by moves from rest to rest, which cost their time and something extra (s), from any of
   the sources to any of the targets; the rate is acceleration over velocity, 1/s. */
void move(const Cell *before, const Cell *after, const double *cost, const bool *sources,
          const bool *targets, int n_cells, double rate, double extra, double *total,
          int16_t *origin);

/* --- tour.c --- */

/* Points up to which the shortest order is found exactly; what it takes doubles with each. */
enum { MOST_EXACT = 20 };
/* The shortest path from node 0 through n others, and back if return_home: the order of the points,
   which are the other nodes less one. distances: (n + 1) x (n + 1), symmetric, m. False if there is
   not enough memory. */
bool held_karp(int n, const double *distances, bool return_home, int *order);

#endif
