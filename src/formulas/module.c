/* The formulas as the Python module youbot_kinematics.formulas: arrays in, arrays out.

   A function takes one or many: (..., 5) joints or (..., 4, 4) poses, and what it returns has the
   same leading axes. It returns None for what it cannot use: no numbers, of another shape, not
   finite, or not rigid; the Python modules then say what is wrong with it. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#include <numpy/arrayobject.h>

#include <math.h>

#include "formulas.h"

Arm arm;

static const npy_intp JOINTS_SHAPE[] = {JOINTS}, POSE_SHAPE[] = {4, 4};

/* --- arrays --- */

/* A new reference to an object as an array of doubles, in C order, whose last axes have a shape;
   NULL, without a Python error, if it is no such thing. */
static PyArrayObject *as_array(PyObject *object, int n_axes, const npy_intp *shape)
{
    PyArrayObject *array = (PyArrayObject *)object;
    if (PyArray_Check(object) && PyArray_TYPE(array) == NPY_DOUBLE && PyArray_ISCARRAY_RO(array))
        Py_INCREF(array);
    else
        array = (PyArrayObject *)PyArray_FROMANY(object, NPY_DOUBLE, 0, 0, NPY_ARRAY_CARRAY_RO);
    if (!array) {
        PyErr_Clear();
        return NULL;
    }
    int first = PyArray_NDIM(array) - n_axes;
    for (int i = 0; i < n_axes; i++)
        if (first < 0 || PyArray_DIM(array, first + i) != shape[i]) {
            Py_DECREF(array);
            return NULL;
        }
    return array;
}

static bool is_finite(PyArrayObject *array)
{
    const double *values = PyArray_DATA(array);
    for (npy_intp i = 0; i < PyArray_SIZE(array); i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

/* A new array with the axes of another one but for its last n_dropped, then those of a shape. */
static PyArrayObject *new_like(
    PyArrayObject *other, int n_dropped, int n_axes, const npy_intp *shape, int type)
{
    npy_intp dims[NPY_MAXDIMS + 4];
    int n_leading = PyArray_NDIM(other) - n_dropped;
    for (int i = 0; i < n_leading; i++)
        dims[i] = PyArray_DIM(other, i);
    for (int i = 0; i < n_axes; i++)
        dims[n_leading + i] = shape[i];
    return (PyArrayObject *)PyArray_SimpleNew(n_leading + n_axes, dims, type);
}

/* --- forward --- */

/* What a formula of joints gives for each of (..., 5): (..., *shape), one after the other. */
static PyObject *of_joints(
    PyObject *object, void (*formula)(const double *, double *), int n_axes, const npy_intp *shape)
{
    PyArrayObject *q = as_array(object, 1, JOINTS_SHAPE);
    if (!q || !is_finite(q)) {
        Py_XDECREF(q);
        Py_RETURN_NONE;
    }
    PyArrayObject *result = new_like(q, 1, n_axes, shape, NPY_DOUBLE);
    if (result) {
        npy_intp n = PyArray_SIZE(q) / JOINTS, step = n ? PyArray_SIZE(result) / n : 0;
        const double *in = PyArray_DATA(q);
        double *out = PyArray_DATA(result);
        NPY_BEGIN_THREADS_DEF;
        NPY_BEGIN_THREADS_THRESHOLDED(n);
        for (npy_intp i = 0; i < n; i++)
            formula(in + i * JOINTS, out + i * step);
        NPY_END_THREADS;
    }
    Py_DECREF(q);
    return (PyObject *)result;
}

static void tool_pose_at(const double *q, double *T)
{
    tool_pose(q, (double(*)[4])T);
}

static void dh_frames_at(const double *q, double *T)
{
    dh_frames(q, (double(*)[4][4])T);
}

static void jacobian_at(const double *q, double *J)
{
    jacobian(q, (double(*)[JOINTS])J);
}

static void smallest_singular_value_at(const double *q, double *value)
{
    *value = smallest_singular_value(q);
}

static PyObject *py_tool_pose(PyObject *module, PyObject *q)
{
    return of_joints(q, tool_pose_at, 2, POSE_SHAPE);
}

static PyObject *py_dh_frames(PyObject *module, PyObject *q)
{
    return of_joints(q, dh_frames_at, 3, (npy_intp[]){FRAMES, 4, 4});
}

static PyObject *py_jacobian(PyObject *module, PyObject *q)
{
    return of_joints(q, jacobian_at, 2, (npy_intp[]){6, JOINTS});
}

static PyObject *py_smallest_singular_value(PyObject *module, PyObject *q)
{
    return of_joints(q, smallest_singular_value_at, 0, NULL);
}

/* --- inverse --- */

/* What the closed form is asked: poses, limits, and where joint 1 is if the pose leaves it free. */
typedef struct {
    PyArrayObject *T;
    Limits limits;
    double q1;
} Question;

static bool read_joints(PyObject *object, Joints joints)
{
    PyArrayObject *array = as_array(object, 1, JOINTS_SHAPE);
    bool usable = array && PyArray_SIZE(array) == JOINTS;
    if (usable)
        memcpy(joints, PyArray_DATA(array), sizeof(Joints));
    Py_XDECREF(array);
    return usable;
}

static const double (*pose_at(const Question *question, npy_intp i))[4]
{
    return (const double(*)[4])((const double *)PyArray_DATA(question->T) + 16 * i);
}

static npy_intp count(const Question *question)
{
    return PyArray_SIZE(question->T) / 16;
}

/* Arguments (T, lower, upper, seed or None). False, without a Python error, if T is not rigid; with
   one if the others are not what the Python modules always give. */
static bool read_question(PyObject *const *args, Py_ssize_t n_args, Question *question)
{
    Joints seed;
    question->T = NULL;
    if (n_args != 4 || !read_joints(args[1], question->limits.lower)
        || !read_joints(args[2], question->limits.upper)
        || !(args[3] == Py_None || read_joints(args[3], seed))) {
        PyErr_SetString(PyExc_TypeError, "expected (T, lower, upper, seed or None)");
        return false;
    }
    question->q1 = args[3] == Py_None
        ? (question->limits.lower[0] + question->limits.upper[0]) / 2 : seed[0];
    question->T = as_array(args[0], 2, POSE_SHAPE);
    if (!question->T)
        return false;
    for (npy_intp i = 0; i < count(question); i++)
        if (!is_rigid(pose_at(question, i))) {
            Py_CLEAR(question->T);
            return false;
        }
    return true;
}

static PyObject *no_answer(void)
{
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *py_branches(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    Question question;
    if (!read_question(args, n_args, &question))
        return no_answer();
    const npy_intp of_branch[] = {BRANCHES}, of_joint[] = {BRANCHES, JOINTS};
    PyArrayObject *joints = new_like(question.T, 2, 2, of_joint, NPY_DOUBLE);
    PyArrayObject *valid = new_like(question.T, 2, 1, of_branch, NPY_BOOL);
    PyArrayObject *out_of_reach = new_like(question.T, 2, 1, of_branch, NPY_DOUBLE);
    PyArrayObject *limit_excess = new_like(question.T, 2, 2, of_joint, NPY_DOUBLE);
    PyArrayObject *tilt = new_like(question.T, 2, 1, of_branch, NPY_DOUBLE);
    if (joints && valid && out_of_reach && limit_excess && tilt) {
        NPY_BEGIN_THREADS_DEF;
        NPY_BEGIN_THREADS_THRESHOLDED(count(&question));
        for (npy_intp i = 0; i < count(&question); i++) {
            Answer answer;
            solve(pose_at(&question, i), &question.limits, question.q1, &answer);
#define SIZE(field) (npy_intp)sizeof answer.field
#define PUT(field) memcpy(PyArray_BYTES(field) + i * SIZE(field), answer.field, SIZE(field))
            PUT(joints);
            PUT(valid);
            PUT(out_of_reach);
            PUT(limit_excess);
            PUT(tilt);
#undef PUT
#undef SIZE
        }
        NPY_END_THREADS;
    }
    Py_DECREF(question.T);
    /* N takes the references over, and fails if one of them is NULL */
    return Py_BuildValue("NNNNN", joints, valid, out_of_reach, limit_excess, tilt);
}

/* Whether a solution is none of the first k: elbows merge where they are straight. */
static bool is_new(const Joints q, const Joints *found, int k)
{
    for (int i = 0; i < k; i++) {
        bool equal = true;
        for (int j = 0; j < JOINTS; j++)
            equal &= q[j] == found[i][j];
        if (equal)
            return false;
    }
    return true;
}

static PyObject *py_solutions(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    Question question;
    if (!read_question(args, n_args, &question))
        return no_answer();
    bool is_one = PyArray_NDIM(question.T) == 2;
    Answer answer;
    if (is_one)
        solve(pose_at(&question, 0), &question.limits, question.q1, &answer);
    Py_DECREF(question.T);
    if (!is_one)
        Py_RETURN_NONE;
    Joints found[BRANCHES];
    npy_intp dims[] = {0, JOINTS};
    for (int i = 0; i < BRANCHES; i++)
        if (answer.valid[i] && is_new(answer.joints[i], found, (int)dims[0]))
            memcpy(found[dims[0]++], answer.joints[i], sizeof(Joints));
    PyObject *result = PyArray_SimpleNew(2, dims, NPY_DOUBLE);
    if (result)
        memcpy(PyArray_DATA((PyArrayObject *)result), found, (size_t)dims[0] * sizeof(Joints));
    return result;
}

static PyObject *py_azimuth(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    Question question;
    if (!read_question(args, n_args, &question))
        return no_answer();
    bool is_one = PyArray_NDIM(question.T) == 2;
    double phi = is_one ? front_azimuth(pose_at(&question, 0), &question.limits, question.q1) : 0;
    Py_DECREF(question.T);
    if (!is_one)
        Py_RETURN_NONE;
    return PyFloat_FromDouble(phi);
}

static PyObject *py_flaws(PyObject *module, PyObject *object)
{
    PyArrayObject *T = as_array(object, 2, POSE_SHAPE);
    if (!T)
        Py_RETURN_NONE;
    Flaws worst = {.finite = true};
    for (npy_intp i = 0; i < PyArray_SIZE(T) / 16; i++) {
        Flaws own = flaws((const double(*)[4])((const double *)PyArray_DATA(T) + 16 * i));
        worst.finite &= own.finite;
        worst.left_handed |= own.left_handed;
        worst.rotation_error = fmax(worst.rotation_error, own.rotation_error);
        worst.last_row_error = fmax(worst.last_row_error, own.last_row_error);
    }
    Py_DECREF(T);
    return Py_BuildValue("NdNd", PyBool_FromLong(worst.finite), worst.rotation_error,
                         PyBool_FromLong(worst.left_handed), worst.last_row_error);
}

/* --- the parts of the closed form, for the questions that planar.py and position.py ask --- */

static PyObject *py_bend(PyObject *module, PyObject *object)
{
    static const npy_intp row[] = {3}, joints_shape[] = {2, 3};
    PyArrayObject *places = as_array(object, 1, row);
    if (!places)
        Py_RETURN_NONE;
    PyArrayObject *joints = new_like(places, 1, 2, joints_shape, NPY_DOUBLE);
    PyArrayObject *beyond = new_like(places, 1, 0, NULL, NPY_DOUBLE);
    if (joints && beyond) {
        const double *in = PyArray_DATA(places);
        double *out = PyArray_DATA(joints), *out_beyond = PyArray_DATA(beyond);
        for (npy_intp i = 0; i < PyArray_SIZE(places) / 3; i++, in += 3, out += 6)
            out_beyond[i] = bend((Point){in[0], in[1]}, in[2], (double(*)[3])out);
    }
    Py_DECREF(places);
    return Py_BuildValue("NN", joints, beyond);
}

static PyObject *py_two_links(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    static const npy_intp row[] = {2};
    double l1 = n_args == 3 ? PyFloat_AsDouble(args[1]) : 0;
    double l2 = n_args == 3 ? PyFloat_AsDouble(args[2]) : 0;
    if (PyErr_Occurred())
        return NULL;
    PyArrayObject *points = n_args == 3 ? as_array(args[0], 1, row) : NULL;
    if (!points)
        Py_RETURN_NONE;
    PyArrayObject *a = new_like(points, 1, 1, row, NPY_DOUBLE);
    PyArrayObject *b = new_like(points, 1, 1, row, NPY_DOUBLE);
    PyArrayObject *beyond = new_like(points, 1, 0, NULL, NPY_DOUBLE);
    if (a && b && beyond) {
        const double *in = PyArray_DATA(points);
        double *out_a = PyArray_DATA(a), *out_b = PyArray_DATA(b), *out = PyArray_DATA(beyond);
        for (npy_intp i = 0; i < PyArray_SIZE(points) / 2; i++)
            out[i] = two_links(in[2 * i], in[2 * i + 1], l1, l2, out_a + 2 * i, out_b + 2 * i);
    }
    Py_DECREF(points);
    return Py_BuildValue("NNN", a, b, beyond);
}

/* Angles (..., m) with limits (m,), or of any shape with one lower and one upper limit. */
static PyObject *py_turned(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    PyArrayObject *angles = n_args == 3 ? as_array(args[0], 0, NULL) : NULL;
    PyArrayObject *lower = n_args == 3 ? as_array(args[1], 0, NULL) : NULL;
    PyArrayObject *upper = n_args == 3 ? as_array(args[2], 0, NULL) : NULL;
    npy_intp m = lower ? PyArray_SIZE(lower) : 0;
    PyArrayObject *result = NULL;
    if (angles && upper && m && PyArray_SIZE(upper) == m && PyArray_SIZE(angles) % m == 0) {
        result = new_like(angles, 0, 0, NULL, NPY_DOUBLE);
        const double *low = PyArray_DATA(lower), *high = PyArray_DATA(upper);
        const double *in = PyArray_DATA(angles);
        double *out = result ? PyArray_DATA(result) : NULL, excess;
        npy_intp n = result ? PyArray_SIZE(angles) / m : 0;
        for (npy_intp i = 0; i < n; i++)
            for (npy_intp j = 0; j < m; j++)
                *out++ = turned(*in++, low[j], high[j], &excess);
    } else
        PyErr_SetString(PyExc_ValueError, "expected angles (..., m), lower (m,) and upper (m,)");
    Py_XDECREF(angles);
    Py_XDECREF(lower);
    Py_XDECREF(upper);
    return (PyObject *)result;
}

/* --- where the arm can stand, for resolve/, whose arrays are always as they must be: else it is a
   TypeError --- */

enum { PLACE_SIZE = sizeof(Place) / sizeof(double) };

/* Whether an array has n values of a type, one after the other. */
static bool has(PyArrayObject *array, int type, npy_intp n)
{
    return PyArray_TYPE(array) == type && PyArray_ISCARRAY_RO(array) && PyArray_SIZE(array) == n;
}

static PyObject *unusable(void)
{
    return PyErr_Occurred() ? NULL : PyErr_Format(PyExc_TypeError, "not what resolve makes");
}

static PyObject *py_stand(PyObject *module, PyObject *args)
{
    PyArrayObject *places, *branch, *pitch;
    PyObject *lower, *upper;
    Limits limits;
    if (!PyArg_ParseTuple(args, "O!O!O!OO", &PyArray_Type, &places, &PyArray_Type, &branch,
                          &PyArray_Type, &pitch, &lower, &upper))
        return NULL;
    npy_intp n = PyArray_SIZE(pitch), dims[] = {n, STAND_JOINTS};
    if (!has(places, NPY_DOUBLE, n * PLACE_SIZE) || !has(branch, NPY_INTP, n)
        || !has(pitch, NPY_DOUBLE, n) || !read_joints(lower, limits.lower)
        || !read_joints(upper, limits.upper))
        return unusable();
    PyArrayObject *joints = (PyArrayObject *)PyArray_SimpleNew(2, dims, NPY_DOUBLE);
    PyArrayObject *excess = (PyArrayObject *)PyArray_SimpleNew(2, dims, NPY_DOUBLE);
    for (npy_intp i = 0; joints && excess && i < n; i++) {
        double q[2][STAND_JOINTS], beyond[2][STAND_JOINTS];
        npy_intp at = ((npy_intp *)PyArray_DATA(branch))[i];
        stand((Place *)PyArray_DATA(places) + i, at >> 1 & 1, ((double *)PyArray_DATA(pitch))[i],
              &limits, q, beyond);
        memcpy(PyArray_GETPTR1(joints, i), q[at & 1], sizeof q[0]);
        memcpy(PyArray_GETPTR1(excess, i), beyond[at & 1], sizeof q[0]);
    }
    return Py_BuildValue("NN", joints, excess);
}

static PyObject *py_standings(PyObject *module, PyObject *args)
{
    PyArrayObject *places, *pitches;
    PyObject *lower, *upper, *velocities;
    Limits limits;
    Joints velocity;
    int finer;
    if (!PyArg_ParseTuple(args, "O!O!iOOO", &PyArray_Type, &places, &PyArray_Type, &pitches, &finer,
                          &lower, &upper, &velocities))
        return NULL;
    npy_intp n = PyArray_SIZE(places) / PLACE_SIZE, n_tried = PyArray_SIZE(pitches);
    if (!has(places, NPY_DOUBLE, n * PLACE_SIZE) || !has(pitches, NPY_DOUBLE, n_tried) || finer < 1
        || n_tried % finer || !read_joints(lower, limits.lower) || !read_joints(upper, limits.upper)
        || !read_joints(velocities, velocity))
        return unusable();
    npy_intp n_cells = n_tried / finer, dims[] = {n, BRANCHES, n_cells, STAND_JOINTS};
    PyArrayObject *cells = (PyArrayObject *)PyArray_SimpleNew(4, dims, NPY_FLOAT);
    PyArrayObject *pitch = (PyArrayObject *)PyArray_SimpleNew(3, dims, NPY_FLOAT);
    for (npy_intp i = 0; cells && pitch && i < n; i++)
        standings((Place *)PyArray_DATA(places) + i, PyArray_DATA(pitches), (int)n_cells, finer,
                  &limits, velocity, PyArray_GETPTR1(cells, i), PyArray_GETPTR1(pitch, i));
    return Py_BuildValue("NN", cells, pitch);
}

/* --- the search, likewise --- */

/* New arrays for the costs of cells and for where they come from. */
static PyObject *new_step(npy_intp n_cells, double **total, int16_t **origin)
{
    PyArrayObject *costs = (PyArrayObject *)PyArray_SimpleNew(1, &n_cells, NPY_DOUBLE);
    PyArrayObject *cells = (PyArrayObject *)PyArray_SimpleNew(1, &n_cells, NPY_INT16);
    *total = costs ? PyArray_DATA(costs) : NULL;
    *origin = cells ? PyArray_DATA(cells) : NULL;
    return Py_BuildValue("NN", costs, cells);
}

static PyObject *py_smooth_step(PyObject *module, PyObject *args)
{
    PyArrayObject *before, *after, *cost;
    int reach;
    float tear;
    if (!PyArg_ParseTuple(args, "O!O!O!if", &PyArray_Type, &before, &PyArray_Type, &after,
                          &PyArray_Type, &cost, &reach, &tear))
        return NULL;
    npy_intp n = PyArray_SIZE(cost);
    if (!has(before, NPY_FLOAT, n * STAND_JOINTS) || !has(after, NPY_FLOAT, n * STAND_JOINTS)
        || !has(cost, NPY_DOUBLE, n) || n % BRANCHES || n / BRANCHES < reach)
        return unusable();
    double *total;
    int16_t *origin;
    PyObject *step = new_step(n, &total, &origin);
    if (step)
        smooth_step(PyArray_DATA(before), PyArray_DATA(after), PyArray_DATA(cost),
                    (int)n / BRANCHES, reach, tear, total, origin);
    return step;
}

static PyObject *py_move(PyObject *module, PyObject *args)
{
    PyArrayObject *before, *after, *cost, *sources, *targets;
    double rate, extra;
    if (!PyArg_ParseTuple(args, "O!O!O!O!O!dd", &PyArray_Type, &before, &PyArray_Type, &after,
                          &PyArray_Type, &cost, &PyArray_Type, &sources, &PyArray_Type, &targets,
                          &rate, &extra))
        return NULL;
    npy_intp n = PyArray_SIZE(cost);
    if (!has(before, NPY_FLOAT, n * STAND_JOINTS) || !has(after, NPY_FLOAT, n * STAND_JOINTS)
        || !has(cost, NPY_DOUBLE, n) || !has(sources, NPY_BOOL, n) || !has(targets, NPY_BOOL, n))
        return unusable();
    double *total;
    int16_t *origin;
    PyObject *step = new_step(n, &total, &origin);
    if (step)
        move(PyArray_DATA(before), PyArray_DATA(after), PyArray_DATA(cost), PyArray_DATA(sources),
             PyArray_DATA(targets), (int)n, rate, extra, total, origin);
    return step;
}

/* --- the visiting order --- */

static PyObject *py_held_karp(PyObject *module, PyObject *const *args, Py_ssize_t n_args)
{
    PyArrayObject *distances = n_args == 2 ? as_array(args[0], 0, NULL) : NULL;
    npy_intp n = distances && PyArray_NDIM(distances) == 2 ? PyArray_DIM(distances, 0) - 1 : -1;
    int return_home = n_args == 2 ? PyObject_IsTrue(args[1]) : -1;
    PyObject *result = NULL;
    int order[MOST_EXACT];
    bool has_memory = true;
    if (n < 0 || n > MOST_EXACT || PyArray_DIM(distances, 1) != n + 1 || return_home < 0)
        PyErr_Format(PyExc_ValueError, "expected distances of at most %d nodes", MOST_EXACT + 1);
    else {
        Py_BEGIN_ALLOW_THREADS
        has_memory = held_karp((int)n, PyArray_DATA(distances), return_home, order);
        Py_END_ALLOW_THREADS
        if (has_memory)
            result = PyArray_SimpleNew(1, &n, NPY_INTP);
        else
            PyErr_NoMemory();
    }
    for (npy_intp i = 0; result && i < n; i++)
        ((npy_intp *)PyArray_DATA((PyArrayObject *)result))[i] = order[i];
    Py_XDECREF(distances);
    return result;
}

/* --- the module --- */

static PyMethodDef FUNCTIONS[] = {
    {"tool_pose", py_tool_pose, METH_O, "tool_pose(q): (..., 4, 4)"},
    {"dh_frames", py_dh_frames, METH_O, "dh_frames(q): (..., 6, 4, 4)"},
    {"jacobian", py_jacobian, METH_O, "jacobian(q): (..., 6, 5)"},
    {"smallest_singular_value", py_smallest_singular_value, METH_O,
     "smallest_singular_value(q): of the Jacobian, (...)"},
    {"branches", (PyCFunction)(void (*)(void))py_branches, METH_FASTCALL,
     "branches(T, lower, upper, seed): the five fields of inverse.Branches"},
    {"solutions", (PyCFunction)(void (*)(void))py_solutions, METH_FASTCALL,
     "solutions(T, lower, upper, seed): the distinct solutions (k, 5) for one pose"},
    {"azimuth", (PyCFunction)(void (*)(void))py_azimuth, METH_FASTCALL,
     "azimuth(T, lower, upper, seed): of the arm's plane for one pose, rad"},
    {"flaws", py_flaws, METH_O,
     "flaws(T): (finite, error of R^T R, left-handed, error of the last row), the worst of all"},
    {"bend", py_bend, METH_O,
     "bend(rows of r, z, pitch): joints 2 to 4 (..., 2, 3), out of reach (...)"},
    {"two_links", (PyCFunction)(void (*)(void))py_two_links, METH_FASTCALL,
     "two_links(rows of x, y, l1, l2): a (..., 2), b (..., 2), out of reach (...)"},
    {"turned", (PyCFunction)(void (*)(void))py_turned, METH_FASTCALL,
     "turned(angles, lower, upper): next to their ranges by whole turns"},
    {"stand", py_stand, METH_VARARGS,
     "stand(places, branches, pitches, lower, upper): joints 1 to 4 (n, 4), their excess (n, 4)"},
    {"standings", py_standings, METH_VARARGS,
     "standings(places, pitches, finer, *limits): cells (n, 4, P, 4), pitches (n, 4, P)"},
    {"smooth_step", py_smooth_step, METH_VARARGS,
     "smooth_step(before, after, cost, reach, tear): costs (n_cells,), where from (n_cells,)"},
    {"move", py_move, METH_VARARGS,
     "move(before, after, cost, sources, targets, rate, extra): the same"},
    {"held_karp", (PyCFunction)(void (*)(void))py_held_karp, METH_FASTCALL,
     "held_karp(distances, return_home): the shortest order (n,)"},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef MODULE = {
    PyModuleDef_HEAD_INIT, "formulas", "The arm's formulas, compiled: see formulas.h.",
    -1, FUNCTIONS, NULL, NULL, NULL, NULL,
};

static bool read_attribute(PyObject *module, const char *name, Joints values)
{
    PyObject *object = PyObject_GetAttrString(module, name);
    bool usable = object && read_joints(object, values);
    Py_XDECREF(object);
    if (!usable && !PyErr_Occurred())
        PyErr_Format(PyExc_ImportError, "arm.%s is not an array (%d,)", name, JOINTS);
    return usable;
}

/* The numbers of the arm are defined once, in arm.py. */
static bool read_arm(void)
{
    PyObject *module = PyImport_ImportModule("youbot_kinematics.arm");
    bool usable = module && read_attribute(module, "OFFSET", arm.offset)
        && read_attribute(module, "A", arm.a) && read_attribute(module, "D", arm.d);
    Py_XDECREF(module);
    return usable;
}

static bool add_constants(PyObject *module)
{
    const struct { const char *name; double value; } constants[] = {
        {"LIMIT_ROUNDING", LIMIT_ROUNDING},
        {"POSE_TOLERANCE", POSE_TOLERANCE},
        {"ON_PLANE", ON_PLANE},
        {"ROTATION_TOLERANCE", ROTATION_TOLERANCE},
        {"LAST_ROW_TOLERANCE", LAST_ROW_TOLERANCE},
    };
    for (size_t i = 0; i < sizeof constants / sizeof *constants; i++)
        if (PyModule_AddObject(module, constants[i].name, PyFloat_FromDouble(constants[i].value)))
            return false;
    return !PyModule_AddIntConstant(module, "MOST_EXACT", MOST_EXACT);
}

PyMODINIT_FUNC PyInit_formulas(void)
{
    import_array();
    PyObject *module = read_arm() ? PyModule_Create(&MODULE) : NULL;
    if (module && !add_constants(module))
        Py_CLEAR(module);
    return module;
}
