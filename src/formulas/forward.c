/* The tool, the frames, the Jacobian and its smallest singular value for given joints.

   Sources: Siciliano et al., "Robotics: Modelling, Planning and Control" (2009), sections 2.8
   (Denavit-Hartenberg) and 3.1 (geometric Jacobian). */
#include "formulas.h"

#include <math.h>
#include <string.h>

/* Columns at an angle whose squared cosine is smaller are at right angles to rounding once they are
   turned, which squares it. No more sweeps over them are made than ever help: it takes some five. */
#define ORTHOGONAL 1e-16
#define MOST_SWEEPS 12

/* An angle, as it is needed. */
typedef struct { double cos, sin; } Turn;

typedef struct { Turn phi, t2, t23, beta, gamma; } Posture;

typedef struct { Point shoulder, elbow, wrist, hand, tool; } Chain;

static inline Turn turn(double angle)
{
    return (Turn){cos(angle), sin(angle)};
}

static inline Posture posture(const Joints q)
{
    double t2 = q[1] + arm.offset[1], t23 = t2 + q[2] + arm.offset[2];
    return (Posture){
        turn(arm.offset[0] - q[0]),
        turn(t2),
        turn(t23),
        turn(t23 + q[3] + arm.offset[3]),
        turn(-arm.offset[4] - q[4]),
    };
}

/* The origins of the Denavit-Hartenberg frames in the arm's plane. */
static inline Chain chain(const Posture *p)
{
    const double *a = arm.a, *d = arm.d;
    Chain c;
    c.shoulder = (Point){-a[0], d[0]};
    c.elbow = (Point){c.shoulder.r + a[1] * p->t2.sin, c.shoulder.z + a[1] * p->t2.cos};
    c.wrist = (Point){c.elbow.r + a[2] * p->t23.sin, c.elbow.z + a[2] * p->t23.cos};
    c.hand = (Point){c.wrist.r - a[3] * p->beta.cos, c.wrist.z + a[3] * p->beta.sin};
    c.tool = (Point){c.hand.r - d[4] * p->beta.sin, c.hand.z - d[4] * p->beta.cos};
    return c;
}

static inline void set_column(Pose T, int column, double x, double y, double z)
{
    T[0][column] = x, T[1][column] = y, T[2][column] = z, T[3][column] = 0;
}

static inline void set_origin(Pose T, Turn phi, Point point)
{
    set_column(T, 3, point.r * phi.cos, point.r * phi.sin, point.z);
    T[3][3] = 1;
}

/* Rz(phi) Ry(beta) Rz(gamma) at a point of the plane. */
static inline void set_tool(Pose T, Turn phi, Turn beta, Turn gamma, Point point)
{
    set_column(T, 0,
        phi.cos * beta.cos * gamma.cos - phi.sin * gamma.sin,
        phi.sin * beta.cos * gamma.cos + phi.cos * gamma.sin,
        -beta.sin * gamma.cos);
    set_column(T, 1,
        -phi.cos * beta.cos * gamma.sin - phi.sin * gamma.cos,
        -phi.sin * beta.cos * gamma.sin + phi.cos * gamma.cos,
        beta.sin * gamma.sin);
    set_column(T, 2, phi.cos * beta.sin, phi.sin * beta.sin, beta.cos);
    set_origin(T, phi, point);
}

/* A frame whose x axis is along a link that leans from the vertical; its z axis is the normal of
   the plane, (-sin phi, cos phi, 0), about which the arm bends. */
static inline void set_link(Pose T, Turn phi, Turn lean, Point point)
{
    set_column(T, 0, phi.cos * lean.sin, phi.sin * lean.sin, lean.cos);
    set_column(T, 1, phi.cos * lean.cos, phi.sin * lean.cos, -lean.sin);
    set_column(T, 2, -phi.sin, phi.cos, 0);
    set_origin(T, phi, point);
}

void tool_pose(const Joints q, Pose T)
{
    Posture p = posture(q);
    set_tool(T, p.phi, p.beta, p.gamma, chain(&p).tool);
}

void dh_frames(const Joints q, Pose T[FRAMES])
{
    static const Pose identity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    const Turn horizontal_back = {0, -1};
    Posture p = posture(q);
    Chain c = chain(&p);
    memcpy(T[0], identity, sizeof identity);
    set_link(T[1], p.phi, horizontal_back, c.shoulder);
    set_link(T[2], p.phi, p.t2, c.elbow);
    set_link(T[3], p.phi, p.t23, c.wrist);
    /* Joint 5's axis points back along the tool. */
    set_column(T[4], 0, -p.phi.cos * p.beta.cos, -p.phi.sin * p.beta.cos, p.beta.sin);
    set_column(T[4], 1, -p.phi.sin, p.phi.cos, 0);
    set_column(T[4], 2, -p.phi.cos * p.beta.sin, -p.phi.sin * p.beta.sin, -p.beta.cos);
    set_origin(T[4], p.phi, c.hand);
    set_tool(T[5], p.phi, p.beta, p.gamma, c.tool);
}

/* Column i of the Jacobian for a joint at a point of the plane, about its normal: normal x lever
   over the normal (-sin phi, cos phi, 0). */
static inline void set_bend(double J[6][JOINTS], int i, Turn phi, Point joint, Point tool)
{
    double r = tool.r - joint.r, z = tool.z - joint.z;
    J[0][i] = z * phi.cos, J[1][i] = z * phi.sin, J[2][i] = -r;
    J[3][i] = -phi.sin, J[4][i] = phi.cos, J[5][i] = 0;
}

void jacobian(const Joints q, double J[6][JOINTS])
{
    Posture p = posture(q);
    Chain c = chain(&p);
    Turn phi = p.phi, beta = p.beta;
    /* Joint 1 turns about -z. */
    J[0][0] = c.tool.r * phi.sin, J[1][0] = -c.tool.r * phi.cos, J[2][0] = 0;
    J[3][0] = 0, J[4][0] = 0, J[5][0] = -1;
    set_bend(J, 1, phi, c.shoulder, c.tool);
    set_bend(J, 2, phi, c.elbow, c.tool);
    set_bend(J, 3, phi, c.wrist, c.tool);
    /* Joint 5 turns about minus the tool's z axis, and the tool is on that. */
    J[0][4] = 0, J[1][4] = 0, J[2][4] = 0;
    J[3][4] = -phi.cos * beta.sin, J[4][4] = -phi.sin * beta.sin, J[5][4] = -beta.cos;
}

/* --- singular values --- */

/* Turns two columns of a matrix into two at right angles, which leaves its singular values as they
   are. Returns the squared cosine of the angle that they had. */
static double make_orthogonal(double x[3], double y[3])
{
    double xx = 0, yy = 0, xy = 0;
    for (int i = 0; i < 3; i++)
        xx += x[i] * x[i], yy += y[i] * y[i], xy += x[i] * y[i];
    if (xy == 0)
        return 0;
    double ratio = (yy - xx) / (2 * xy);
    double tangent = copysign(1, ratio) / (fabs(ratio) + sqrt(1 + ratio * ratio));
    double cosine = 1 / sqrt(1 + tangent * tangent), sine = cosine * tangent;
    for (int i = 0; i < 3; i++) {
        double turned = cosine * x[i] - sine * y[i];
        y[i] = sine * x[i] + cosine * y[i];
        x[i] = turned;
    }
    return xy * xy / (xx * yy);
}

/* The smallest singular value of a 3 x n matrix with these columns, which it turns: where all are at
   right angles, their lengths are the singular values. Source: Hestenes, "Inversion of matrices by
   biorthogonalization and related results" (1958). */
static double smallest_value(double columns[][3], int n)
{
    double most = 1, smallest = INFINITY;
    for (int sweep = 0; most > ORTHOGONAL && sweep < MOST_SWEEPS; sweep++) {
        most = 0;
        for (int i = 0; i < n; i++)
            for (int j = i + 1; j < n; j++)
                most = fmax(most, make_orthogonal(columns[i], columns[j]));
    }
    for (int i = 0; i < n; i++) {
        const double *x = columns[i];
        smallest = fmin(smallest, sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
    }
    return smallest;
}

double smallest_singular_value(const Joints q)
{
    Posture p = posture(q);
    Chain c = chain(&p);
    double in_plane[3][3] = {
        {c.tool.z - c.shoulder.z, c.shoulder.r - c.tool.r, 1},
        {c.tool.z - c.elbow.z, c.elbow.r - c.tool.r, 1},
        {c.tool.z - c.wrist.z, c.wrist.r - c.tool.r, 1},
    };
    double across[2][3] = {{c.tool.r, 0, 1}, {0, p.beta.sin, p.beta.cos}};
    return fmin(smallest_value(in_plane, 3), smallest_value(across, 2));
}
