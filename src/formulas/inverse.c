/* The closed form for one pose of the tool: inverse.py says what the branches are. */
#include "formulas.h"

#include <math.h>

/* A tool whose z axis has a smaller horizontal part is vertical. */
#define VERTICAL 1e-9
/* An elbow whose cosine is so near to 1 is straight: rounding, as a part of the squares in it. */
#define COSINE_ROUNDING 1e-14
/* Points this little out of reach (m) are on its edge: others' forward kinematics put them so. */
#define EDGE 1e-10

double turned(double angle, double lower, double upper, double *excess)
{
    *excess = 0;
    if (lower <= angle && angle <= upper)
        return angle;
    angle += 2 * PI * rint(((lower + upper) / 2 - angle) / (2 * PI));
    double on_limit = fmin(fmax(angle, lower), upper);
    if (fabs(angle - on_limit) <= LIMIT_ROUNDING)
        return on_limit;
    *excess = angle - on_limit;
    return angle;
}

/* --- the plane of the arm: two links that carry the tool --- */

double two_links(double x, double y, double l1, double l2, double a[2], double b[2])
{
    double distance = hypot(x, y), direction = atan2(y, x);
    double squares = l1 * l1 + l2 * l2, product = 2 * l1 * l2;
    double cos_b = (distance * distance - squares) / product;
    double rounding = COSINE_ROUNDING * squares / product;
    double beyond = fmax(distance - (l1 + l2), 0) + fmin(distance - fabs(l1 - l2), 0);
    if (cos_b >= 1 - rounding) {
        a[0] = a[1] = direction;
        b[0] = b[1] = 0;
    } else if (cos_b <= -1 + rounding) { /* to both sides the same: pi, not -pi */
        a[0] = a[1] = direction - atan2(l2 * sin(PI), l1 - l2);
        b[0] = b[1] = PI;
    } else {
        double elbow = acos(cos_b), lean = atan2(l2 * sin(elbow), l1 + l2 * cos_b);
        a[0] = direction - lean, a[1] = direction + lean;
        b[0] = elbow, b[1] = -elbow;
    }
    return fabs(beyond) <= EDGE ? 0 : beyond;
}

/* bend, for a pitch whose cosine and sine are known. */
static inline double bend_at(Point tool, double pitch, double c, double s, double joints[2][3])
{
    const double *offset = arm.offset, *a = arm.a, *d = arm.d;
    double t2[2], elbow[2];
    double wrist_r = tool.r + a[0] + a[3] * c + d[4] * s;
    double wrist_z = tool.z - d[0] - a[3] * s + d[4] * c;
    /* Angles count from the vertical, towards r: z is the two links' x axis, r their y axis. */
    double beyond = two_links(wrist_z, wrist_r, a[1], a[2], t2, elbow);
    for (int i = 0; i < 2; i++) {
        joints[i][0] = t2[i] - offset[1];
        joints[i][1] = elbow[i] - offset[2];
        joints[i][2] = pitch - t2[i] - elbow[i] - offset[3];
    }
    return beyond;
}

double bend(Point tool, double pitch, double joints[2][3])
{
    return bend_at(tool, pitch, cos(pitch), sin(pitch), joints);
}

/* --- which plane: the azimuth --- */

/* The azimuth nearest to joint 1 at q1 that keeps joints 1 and 5 inside, tool vertical.

   Only the sum of the two angles is given if the tool points up, their difference if it points
   down: q5 = k - up * q1. So either joint 1 can stay at q1, or one of the two is on a limit. */
static double free_azimuth(const Pose T, const Limits *limits, double q1)
{
    const double *lower = limits->lower, *upper = limits->upper;
    double up = T[2][2] > 0 ? 1 : -1;
    double k = -arm.offset[4] + up * arm.offset[0] - up * atan2(up * T[1][0], up * T[0][0]);
    double stay = fmin(fmax(q1, lower[0]), upper[0]);
    double choices[] = {stay, lower[0], upper[0], up * (k - lower[4]), up * (k - upper[4])};
    double excess, nearest = INFINITY, best = turned(stay, lower[0], upper[0], &excess);
    for (int i = 0; i < 5; i++) {
        double excess_1, excess_5, first = turned(choices[i], lower[0], upper[0], &excess_1);
        turned(k - up * choices[i], lower[4], upper[4], &excess_5);
        if (excess_1 == 0 && excess_5 == 0 && fabs(first - q1) < nearest) {
            best = first;
            nearest = fabs(first - q1);
        }
    }
    return arm.offset[0] - best;
}

double front_azimuth(const Pose T, const Limits *limits, double q1)
{
    double x = T[0][3], y = T[1][3], tool_x = T[0][2], tool_y = T[1][2];
    double radius = hypot(x, y), horizontal = hypot(tool_x, tool_y);
    if (radius < ON_PLANE && horizontal <= VERTICAL)
        return free_azimuth(T, limits, q1);
    /* The nearer to joint 1's axis, the more rounding blurs the azimuth of the position; the more
       upright the tool, that of its z axis. The longer arrow tells the plane better. */
    if (horizontal > radius) {
        double by_tool = atan2(tool_y, tool_x), c = cos(by_tool), s = sin(by_tool);
        if (fabs(y * c - x * s) < ON_PLANE) /* the tool may lean back over the axis */
            return x * c + y * s < -ON_PLANE ? by_tool + PI : by_tool;
    }
    return atan2(y, x);
}

/* --- the four branches --- */

/* A pose as seen from a plane of the arm: its point, and the nearest rotation Ry(pitch) Rz(roll)
   that the arm can give the tool there, off by the tilt. */
typedef struct {
    Point point;
    double pitch, cos_pitch, sin_pitch, roll, tilt;
} PlanePose;

/* The nearest rotation turns the tool's z axis into the plane on the shortest way. (It is the one
   that the singular value decomposition of the quaternion's matrix [[w, z], [y, x]] gives.) */
static PlanePose seen_from(const Pose T, double azimuth)
{
    double c = cos(azimuth), s = sin(azimuth);
    double along[3], across[3]; /* rows of Rz(-azimuth) R; its third is R's */
    for (int i = 0; i < 3; i++) {
        along[i] = c * T[0][i] + s * T[1][i];
        across[i] = c * T[1][i] - s * T[0][i];
    }
    PlanePose pose = {.point = {c * T[0][3] + s * T[1][3], T[2][3]}};
    pose.pitch = atan2(along[2], T[2][2]);
    pose.cos_pitch = cos(pose.pitch);
    pose.sin_pitch = sin(pose.pitch);
    /* A = Ry(-pitch) Rz(-azimuth) R turns about z by the roll, as nearly as it can:
       maximise trace(Rz(-roll) A). */
    double a00 = pose.cos_pitch * along[0] - pose.sin_pitch * T[2][0];
    double a01 = pose.cos_pitch * along[1] - pose.sin_pitch * T[2][1];
    pose.roll = atan2(across[0] - a01, a00 + across[1]);
    pose.tilt = asin(fmin(fabs(across[2]), 1));
    return pose;
}

/* The same from the plane turned by half a turn: r and the pitch change their signs, for
   Rz(pi) Ry(-pitch) Rz(pi) = Ry(pitch). */
static PlanePose seen_from_the_back(PlanePose front)
{
    PlanePose back = front;
    back.point.r = -front.point.r;
    back.pitch = -front.pitch;
    back.sin_pitch = -front.sin_pitch;
    back.roll = front.roll + PI;
    return back;
}

/* The two branches, elbow + and -, of an arm in the plane of an azimuth. */
static void solve_in_plane(
    const PlanePose *pose, double azimuth, const Limits *limits, Answer *answer, int first)
{
    double bent[2][3];
    double beyond = bend_at(pose->point, pose->pitch, pose->cos_pitch, pose->sin_pitch, bent);
    for (int elbow = 0; elbow < 2; elbow++) {
        int i = first + elbow;
        double *q = answer->joints[i], *excess = answer->limit_excess[i];
        const Joints raw = {arm.offset[0] - azimuth, bent[elbow][0], bent[elbow][1],
                            bent[elbow][2], -arm.offset[4] - pose->roll};
        bool valid = beyond == 0 && pose->tilt <= POSE_TOLERANCE;
        for (int j = 0; j < JOINTS; j++) {
            q[j] = turned(raw[j], limits->lower[j], limits->upper[j], &excess[j]);
            valid &= excess[j] == 0;
        }
        answer->valid[i] = valid;
        answer->out_of_reach[i] = beyond;
        answer->tilt[i] = pose->tilt;
    }
}

void solve(const Pose T, const Limits *limits, double q1, Answer *answer)
{
    double azimuth = front_azimuth(T, limits, q1);
    PlanePose front = seen_from(T, azimuth), back = seen_from_the_back(front);
    solve_in_plane(&front, azimuth, limits, answer, 0);
    solve_in_plane(&back, azimuth + PI, limits, answer, 2);
}

/* --- is it a pose? --- */

static double determinant(const Pose R)
{
    return R[0][0] * (R[1][1] * R[2][2] - R[1][2] * R[2][1])
         - R[0][1] * (R[1][0] * R[2][2] - R[1][2] * R[2][0])
         + R[0][2] * (R[1][0] * R[2][1] - R[1][1] * R[2][0]);
}

Flaws flaws(const Pose T)
{
    Flaws found = {.finite = true, .left_handed = determinant(T) < 0};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++)
            found.finite &= isfinite(T[i][j]);
        found.last_row_error = fmax(found.last_row_error, fabs(T[3][i] - (i == 3)));
    }
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double dot = T[0][i] * T[0][j] + T[1][i] * T[1][j] + T[2][i] * T[2][j];
            found.rotation_error = fmax(found.rotation_error, fabs(dot - (i == j)));
        }
    return found;
}

bool is_rigid(const Pose T)
{
    Flaws found = flaws(T);
    return found.finite && !found.left_handed && found.rotation_error <= ROTATION_TOLERANCE
        && found.last_row_error <= LAST_ROW_TOLERANCE;
}
