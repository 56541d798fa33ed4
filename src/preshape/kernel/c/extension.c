/* The kernel as a CPython module: convolve for arrays, Engine for streams. kernel/stream_reference.py is its twin.
 *
 * Engine holds axes x stages rings. It runs without Python's lock while it shapes a block; meanwhile it is marked busy,
 * and any other call on it is refused. Samples are float64 throughout.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

/* Variants of the hot loops for wider vectors, chosen when the module is loaded (glibc's ifunc); same bits. */
#if defined(__GNUC__) && !defined(__clang__) && (__GNUC__ >= 11) && defined(__x86_64__) && defined(__GLIBC__)
#define PRESHAPE_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#endif
#include "preshape_kernel.c"

#define LARGE ((size_t)8192) /* samples from which on checking while shaping pays, and keeping the old ring is nothing */
#define LONGEST_DELAY ((uint32_t)1 << 26)

static PyObject *InputError;

typedef struct {
    preshape_gather gather;
    preshape_scatter scatter;
} Unit;

typedef struct {
    preshape_shaper shaper;
    uint32_t *delays;
    double *weights;
    int scattering;
} Stage;

typedef struct {
    PyObject_HEAD
    Py_ssize_t axes, stages;
    int pass_bad, busy;
    Stage *stage; /* [stages] */
    Unit *unit;   /* [axes][stages] */
    double *held; /* [axes], the last acceptable sample */
} Engine;

/* ---- arrays ------------------------------------------------------------------------------------------------------ */

/* A contiguous buffer of items of this size; the Python side has made sure of the type. */
static int buffer_of(PyObject *object, Py_buffer *view, int writable, Py_ssize_t itemsize, const char *what) {
    if (PyObject_GetBuffer(object, view, PyBUF_C_CONTIGUOUS | (writable ? PyBUF_WRITABLE : 0)) < 0) {
        return -1;
    }
    if ((view->itemsize != itemsize) && (view->itemsize != 1)) {
        PyBuffer_Release(view);
        PyErr_Format(PyExc_TypeError, "%s must have items of %zd bytes", what, itemsize);
        return -1;
    }
    return 0;
}

static uint32_t ring_size(size_t needed) {
    size_t size = 1u;
    while (size < needed) {
        size *= 2u;
    }
    return (uint32_t)size;
}

/* ---- stages and their memory ------------------------------------------------------------------------------------- */

static void stage_clear(Stage *stage) {
    PyMem_RawFree(stage->delays);
    PyMem_RawFree(stage->weights);
    stage->delays = NULL;
    stage->weights = NULL;
}

/* Copy taps from (delays, weights), uint32 and float64 arrays, and check them. */
static int stage_read(Stage *stage, PyObject *delays, PyObject *weights) {
    Py_buffer d, w;
    int result = -1;
    if (buffer_of(delays, &d, 0, 4, "delays") < 0) {
        return -1;
    }
    if (buffer_of(weights, &w, 0, 8, "weights") == 0) {
        const size_t taps = (size_t)d.len / 4u;
        stage->delays = PyMem_RawMalloc((taps + 1u) * sizeof(uint32_t));
        stage->weights = PyMem_RawMalloc((taps + 1u) * sizeof(double));
        if ((stage->delays == NULL) || (stage->weights == NULL)) {
            PyErr_NoMemory();
        } else if (((size_t)w.len / 8u != taps) || (taps > MOST_TAPS)) {
            PyErr_SetString(InputError, "a shaper on the grid needs one weight for each delay.");
        } else {
            memcpy(stage->delays, d.buf, taps * 4u);
            memcpy(stage->weights, w.buf, taps * 8u);
            stage->shaper.delays = stage->delays;
            stage->shaper.weights = stage->weights;
            stage->shaper.taps = (uint32_t)taps;
            const preshape_status status = preshape_check(&stage->shaper, LONGEST_DELAY);
            if (status == PRESHAPE_OK) {
                result = 0;
            } else if (status == PRESHAPE_RING_TOO_SMALL) {
                PyErr_SetString(InputError, "the shaper is longer than 2**26 samples: sample less often.");
            } else {
                PyErr_SetString(InputError, "the taps are no shaper on the grid: delays must increase from 0, weights "
                                            "must be finite and sum to 1.");
            }
        }
        PyBuffer_Release(&w);
    }
    PyBuffer_Release(&d);
    if (result < 0) {
        stage_clear(stage);
    }
    return result;
}

static Unit *unit_of(Engine *self, Py_ssize_t axis, Py_ssize_t stage) {
    return &self->unit[axis * self->stages + stage];
}

static int gather_room(Unit *unit, const preshape_shaper *shaper) {
    const uint32_t size = ring_size(2u * (size_t)longest_of(shaper) + 64u); /* runs of a block need room */
    double *const ring = PyMem_RawMalloc((size_t)size * sizeof(double));
    if (ring == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    PyMem_RawFree(unit->gather.ring);
    (void)preshape_gather_configure(&unit->gather, shaper, ring, size);
    return 0;
}

/* A ring for what is to arrive, with what is in the old one. */
static int scatter_room(Unit *unit, const preshape_shaper *shaper, size_t ahead) {
    preshape_scatter *const s = &unit->scatter;
    const size_t needed = ((size_t)longest_of(shaper) > ahead) ? longest_of(shaper) : ahead;
    const uint32_t size = ring_size(needed + 1u);
    preshape_pair *ring;
    if ((s->ring != NULL) && (s->mask >= size - 1u)) {
        return 0;
    }
    ring = PyMem_RawCalloc(size, sizeof(preshape_pair));
    if (ring == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    if (s->ring == NULL) {
        (void)preshape_scatter_configure(s, shaper, ring, size);
        return 0;
    }
    for (uint32_t i = 0u; i <= s->mask; ++i) {
        ring[i] = s->ring[(s->at + i) & s->mask];
    }
    PyMem_RawFree(s->ring);
    s->ring = ring;
    s->mask = size - 1u;
    s->at = 0u;
    return 0;
}

/* ---- one sample and many ----------------------------------------------------------------------------------------- */

static double step(Engine *self, Py_ssize_t axis, double u) {
    Unit *unit = unit_of(self, axis, 0);
    for (Py_ssize_t j = 0; j < self->stages; ++j, ++unit) {
        u = self->stage[j].scattering ? scatter_step(&unit->scatter, u) : gather_step(&unit->gather, u);
    }
    return u;
}

/* One axis, samples known to be acceptable. */
static void shape_axis(Engine *self, Py_ssize_t axis, const double *u, double *y, size_t count) {
    for (size_t done = 0u; done < count; done += BLOCK) {
        const size_t run = least(count - done, BLOCK);
        Unit *unit = unit_of(self, axis, 0);
        for (Py_ssize_t j = 0; j < self->stages; ++j, ++unit) {
            const double *const from = (j == 0) ? u + done : y + done;
            if (self->stage[j].scattering) {
                for (size_t i = 0u; i < run; ++i) {
                    y[done + i] = scatter_step(&unit->scatter, from[i]);
                }
            } else {
                gather_runs(&unit->gather, from, y + done, run);
            }
        }
    }
}

/* One axis, what is not acceptable passed through while the last acceptable sample is held. */
static void pass_axis(Engine *self, Py_ssize_t axis, const double *u, double *y, size_t count) {
    for (size_t i = 0u; i < count; ++i) {
        if (acceptable(u[i])) {
            self->held[axis] = u[i];
            y[i] = step(self, axis, u[i]);
        } else {
            (void)step(self, axis, self->held[axis]);
            y[i] = u[i];
        }
    }
}

/* All axes; -1 when done, else the place of the first sample that is refused: then nothing has changed but y. */
static Py_ssize_t shape_all(Engine *self, const double *u, double *y, size_t count, double *spare) {
    if (spare != NULL) { /* one axis, one gather */
        preshape_gather *const g = &self->unit->gather;
        const size_t bytes = ((size_t)g->mask + 1u) * sizeof(double);
        const uint32_t at = g->at;
        memcpy(spare, g->ring, bytes);
        const size_t good = preshape_gather_block(g, u, y, count);
        if (good == count) {
            self->held[0] = u[count - 1u];
            return -1;
        }
        memcpy(g->ring, spare, bytes);
        g->at = at;
        if (!self->pass_bad) {
            return (Py_ssize_t)good;
        }
    }
    const size_t total = (size_t)self->axes * count;
    const size_t good = preshape_acceptable(u, total);
    if ((good < total) && !self->pass_bad) {
        return (Py_ssize_t)good;
    }
    for (Py_ssize_t axis = 0; (axis < self->axes) && (count > 0u); ++axis) {
        const size_t first = (size_t)axis * count;
        if (good < total) {
            pass_axis(self, axis, u + first, y + first, count);
        } else {
            shape_axis(self, axis, u + first, y + first, count);
            self->held[axis] = u[first + count - 1u];
        }
    }
    return -1;
}

static int refuse_busy(Engine *self) {
    if (self->busy) {
        PyErr_SetString(PyExc_RuntimeError, "this stream is shaping a block in another thread: samples of one stream "
                                            "have an order; use a lock, or a stream for each thread.");
    }
    return self->busy;
}

static PyObject *refuse(double value, Py_ssize_t axis, Py_ssize_t sample) {
    PyObject *const number = PyFloat_FromDouble(value);
    if ((number != NULL) && (sample < 0)) {
        PyErr_Format(InputError, "the sample is %R: give finite commands within +-1e250, or let such samples through "
                                 "with not_finite=\"pass\".", number);
    } else if (number != NULL) {
        PyErr_Format(InputError, "sample %zd of axis %zd is %R, and nothing of this block was taken: give finite commands "
                                 "within +-1e250, or let such samples through with not_finite=\"pass\".",
                     sample, axis, number);
    }
    Py_XDECREF(number);
    return NULL;
}

/* ---- methods ----------------------------------------------------------------------------------------------------- */

static PyObject *engine_push(Engine *self, PyObject *sample) {
    const double u = PyFloat_AsDouble(sample);
    if (((u == -1.0) && (PyErr_Occurred() != NULL)) || refuse_busy(self)) {
        return NULL;
    }
    if (self->axes != 1) {
        PyErr_SetString(PyExc_ValueError, "push is for one axis");
        return NULL;
    }
    if (acceptable(u)) {
        self->held[0] = u;
        return PyFloat_FromDouble(step(self, 0, u));
    }
    if (!self->pass_bad) {
        return refuse(u, 0, -1);
    }
    (void)step(self, 0, self->held[0]);
    return PyFloat_FromDouble(u);
}

static PyObject *engine_block(Engine *self, PyObject *args) {
    PyObject *command, *shaped;
    Py_buffer u, y;
    if (!PyArg_ParseTuple(args, "OO", &command, &shaped) || refuse_busy(self) ||
        (buffer_of(command, &u, 0, 8, "the command") < 0)) {
        return NULL;
    }
    if (buffer_of(shaped, &y, 1, 8, "the output") < 0) {
        PyBuffer_Release(&u);
        return NULL;
    }
    const size_t count = (size_t)u.len / 8u / (size_t)self->axes;
    const double *const from = u.buf;
    double *const to = y.buf, *spare = NULL;
    Py_ssize_t refused = -1;
    if ((u.len != y.len) || (count * (size_t)self->axes * 8u != (size_t)u.len)) {
        PyErr_SetString(PyExc_ValueError, "command and output must have the same number of samples for each axis");
    } else {
        if ((self->axes == 1) && (self->stages == 1) && !self->stage->scattering && (count >= LARGE) && (from != to)) {
            spare = PyMem_RawMalloc(((size_t)self->unit->gather.mask + 1u) * sizeof(double)); /* NULL: the other way */
        }
        self->busy = 1;
        Py_BEGIN_ALLOW_THREADS
        refused = shape_all(self, from, to, count, spare);
        Py_END_ALLOW_THREADS
        self->busy = 0;
        if (refused >= 0) {
            (void)refuse(from[refused], refused / (Py_ssize_t)count, refused % (Py_ssize_t)count);
        }
    }
    PyMem_RawFree(spare);
    PyBuffer_Release(&u);
    PyBuffer_Release(&y);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

static PyObject *engine_reset(Engine *self, PyObject *values) {
    Py_buffer v;
    if (refuse_busy(self) || (buffer_of(values, &v, 0, 8, "the values") < 0)) {
        return NULL;
    }
    const double *const value = v.buf;
    const int fits = v.len == self->axes * 8;
    const size_t good = fits ? preshape_acceptable(value, (size_t)self->axes) : 0u;
    if (!fits) {
        PyErr_SetString(PyExc_ValueError, "one value for each axis is needed");
    } else if (good < (size_t)self->axes) {
        (void)refuse(value[good], 0, -1);
    } else {
        for (Py_ssize_t axis = 0; axis < self->axes; ++axis) {
            for (Py_ssize_t j = 0; j < self->stages; ++j) {
                Unit *const unit = unit_of(self, axis, j);
                if (self->stage[j].scattering && (gather_room(unit, &self->stage[j].shaper) < 0)) {
                    break;
                }
                (void)preshape_gather_reset(&unit->gather, value[axis]);
            }
            self->held[axis] = value[axis];
        }
        for (Py_ssize_t j = 0; (j < self->stages) && (PyErr_Occurred() == NULL); ++j) {
            self->stage[j].scattering = 0; /* one shaper is in force again */
        }
    }
    PyBuffer_Release(&v);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

static Stage *stage_at(Engine *self, Py_ssize_t index) {
    if ((index < 0) || (index >= self->stages)) {
        PyErr_SetString(PyExc_IndexError, "there is no such stage");
        return NULL;
    }
    return &self->stage[index];
}

static PyObject *engine_retune(Engine *self, PyObject *args) {
    Py_ssize_t index;
    PyObject *delays, *weights;
    Stage fresh = {{NULL, NULL, 0u}, NULL, NULL, 1}, *stage;
    if (!PyArg_ParseTuple(args, "nOO", &index, &delays, &weights) || refuse_busy(self) ||
        ((stage = stage_at(self, index)) == NULL) || (stage_read(&fresh, delays, weights) < 0)) {
        return NULL;
    }
    const uint32_t ahead = longest_of(&fresh.shaper);
    for (Py_ssize_t axis = 0; axis < self->axes; ++axis) { /* all the memory first: nothing is changed without it */
        if (scatter_room(unit_of(self, axis, index), &stage->shaper, ahead) < 0) {
            stage_clear(&fresh);
            return NULL;
        }
    }
    for (Py_ssize_t axis = 0; (axis < self->axes) && !stage->scattering; ++axis) {
        Unit *const unit = unit_of(self, axis, index);
        (void)preshape_scatter_take_over(&unit->scatter, &unit->gather);
    }
    stage_clear(stage);
    *stage = fresh;
    for (Py_ssize_t axis = 0; axis < self->axes; ++axis) {
        (void)preshape_scatter_retune(&unit_of(self, axis, index)->scatter, &stage->shaper);
    }
    Py_RETURN_NONE;
}

static PyObject *engine_scattering(Engine *self, PyObject *args) {
    Py_ssize_t index;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "n", &index) || ((stage = stage_at(self, index)) == NULL)) {
        return NULL;
    }
    return PyBool_FromLong(stage->scattering);
}

/* What one ring remembers, as float64: the past commands from the oldest on, or the last command, the pending pair, the
 * number of samples until all has arrived, and the pairs that arrive until then. */
static PyObject *engine_save(Engine *self, PyObject *args) {
    Py_ssize_t axis, index;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "nn", &axis, &index) || refuse_busy(self) || ((stage = stage_at(self, index)) == NULL)) {
        return NULL;
    }
    if ((axis < 0) || (axis >= self->axes)) {
        PyErr_SetString(PyExc_IndexError, "there is no such axis");
        return NULL;
    }
    const preshape_gather *const g = &unit_of(self, axis, index)->gather;
    const preshape_scatter *const s = &unit_of(self, axis, index)->scatter;
    const size_t count =
        stage->scattering ? 4u + 2u * ((size_t)s->remaining + 1u) : (size_t)longest_of(&stage->shaper) + 1u;
    PyObject *const bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
    if (bytes == NULL) {
        return NULL;
    }
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    char *to = PyBytes_AS_STRING(bytes);
    if (stage->scattering) {
        value[0] = s->command;
        value[1] = s->pending.high;
        value[2] = s->pending.low;
        value[3] = (double)s->remaining;
        memcpy(to, value, sizeof value);
        for (uint32_t i = 0u; i <= s->remaining; ++i) {
            memcpy(to + 32u + 16u * (size_t)i, &s->ring[(s->at + i) & s->mask], 16u);
        }
    } else {
        for (uint32_t i = 0u; i < count; ++i) {
            memcpy(to + 8u * (size_t)i, &g->ring[(g->at - (uint32_t)count + i) & g->mask], 8u);
        }
    }
    return bytes;
}

/* Put back what engine_save gave. */
static PyObject *engine_load(Engine *self, PyObject *args) {
    Py_ssize_t axis, index;
    int scattering;
    Py_buffer v;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "nnpy*", &axis, &index, &scattering, &v)) {
        return NULL;
    }
    const size_t count = (size_t)v.len / sizeof(double);
    double *const value = PyMem_RawMalloc((count + 1u) * sizeof(double)); /* the buffer need not be aligned */
    if (value == NULL) {
        PyErr_NoMemory();
    } else if (!refuse_busy(self) && ((stage = stage_at(self, index)) != NULL)) {
        const size_t needed = (size_t)longest_of(&stage->shaper) + 1u;
        memcpy(value, v.buf, count * sizeof(double));
        int right = (axis >= 0) && (axis < self->axes) && (preshape_acceptable(value, count) == count);
        if (scattering) {
            right = right && (count >= 6u) && (value[3] >= 0.0) && (value[3] < (double)LONGEST_DELAY) &&
                    (count == 4u + 2u * ((size_t)value[3] + 1u));
        } else {
            right = right && (count == needed);
        }
        if (!right) {
            PyErr_SetString(InputError, "the state does not fit this stream: give bytes that Stream.state returned.");
        } else if (scattering && (scatter_room(unit_of(self, axis, index), &stage->shaper, (size_t)value[3]) == 0)) {
            preshape_scatter *const s = &unit_of(self, axis, index)->scatter;
            (void)preshape_scatter_reset(s, value[0]);
            s->pending.high = value[1];
            s->pending.low = value[2];
            s->remaining = (uint32_t)value[3];
            for (uint32_t i = 0u; i <= s->remaining; ++i) {
                s->ring[(s->at + i) & s->mask].high = value[4u + 2u * (size_t)i];
                s->ring[(s->at + i) & s->mask].low = value[5u + 2u * (size_t)i];
            }
            stage->scattering = 1;
            self->held[axis] = (index == 0) ? value[0] : self->held[axis];
        } else if (!scattering) {
            gather_remember(&unit_of(self, axis, index)->gather, value, count);
            stage->scattering = 0;
            self->held[axis] = (index == 0) ? value[count - 1u] : self->held[axis];
        }
    }
    PyMem_RawFree(value);
    PyBuffer_Release(&v);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

static void engine_dealloc(Engine *self) {
    for (Py_ssize_t i = 0; (self->unit != NULL) && (i < self->axes * self->stages); ++i) {
        PyMem_RawFree(self->unit[i].gather.ring);
        PyMem_RawFree(self->unit[i].scatter.ring);
    }
    for (Py_ssize_t j = 0; (self->stage != NULL) && (j < self->stages); ++j) {
        stage_clear(&self->stage[j]);
    }
    PyMem_RawFree(self->unit);
    PyMem_RawFree(self->stage);
    PyMem_RawFree(self->held);
    Py_TYPE(self)->tp_free((PyObject *)self);
}

static PyObject *engine_new(PyTypeObject *type, PyObject *args, PyObject *keywords) {
    static char *names[] = {"axes", "stages", "pass_bad", NULL};
    Py_ssize_t axes;
    PyObject *taps;
    int pass_bad = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "nO!|p", names, &axes, &PyTuple_Type, &taps, &pass_bad)) {
        return NULL;
    }
    const Py_ssize_t stages = PyTuple_GET_SIZE(taps);
    if ((axes < 1) || (axes > 65536) || (stages < 1) || (stages > 1024)) {
        PyErr_SetString(PyExc_ValueError, "axes and stages must be at least 1, and few");
        return NULL;
    }
    Engine *const self = (Engine *)type->tp_alloc(type, 0);
    if (self == NULL) {
        return NULL;
    }
    self->axes = axes;
    self->stages = stages;
    self->pass_bad = pass_bad;
    self->stage = PyMem_RawCalloc((size_t)stages, sizeof(Stage));
    self->unit = PyMem_RawCalloc((size_t)(axes * stages), sizeof(Unit));
    self->held = PyMem_RawCalloc((size_t)axes, sizeof(double));
    if ((self->stage == NULL) || (self->unit == NULL) || (self->held == NULL)) {
        PyErr_NoMemory();
        Py_DECREF(self);
        return NULL;
    }
    for (Py_ssize_t j = 0; j < stages; ++j) {
        PyObject *delays, *weights;
        if (!PyArg_ParseTuple(PyTuple_GET_ITEM(taps, j), "OO", &delays, &weights) ||
            (stage_read(&self->stage[j], delays, weights) < 0)) {
            Py_DECREF(self);
            return NULL;
        }
        for (Py_ssize_t axis = 0; axis < axes; ++axis) {
            if (gather_room(unit_of(self, axis, j), &self->stage[j].shaper) < 0) {
                Py_DECREF(self);
                return NULL;
            }
        }
    }
    return (PyObject *)self;
}

static PyMethodDef engine_methods[] = {
    {"push", (PyCFunction)engine_push, METH_O, "Shape one sample of the first axis."},
    {"block", (PyCFunction)engine_block, METH_VARARGS, "Shape float64 samples (axes, time) into an array of that shape."},
    {"reset", (PyCFunction)engine_reset, METH_O, "As if these values, one an axis, had been commanded for ever."},
    {"retune", (PyCFunction)engine_retune, METH_VARARGS, "Change the taps of a stage for what is commanded from now on."},
    {"scattering", (PyCFunction)engine_scattering, METH_VARARGS, "Whether a stage scatters increments."},
    {"save", (PyCFunction)engine_save, METH_VARARGS, "What the ring of (axis, stage) remembers, as float64."},
    {"load", (PyCFunction)engine_load, METH_VARARGS, "Put back what save gave."},
    {NULL, NULL, 0, NULL},
};

static PyTypeObject EngineType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "preshape.kernel._compiled.Engine",
    .tp_doc = "Axes times stages of shapers; see preshape.kernel.stream_reference.",
    .tp_basicsize = sizeof(Engine),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_new = engine_new,
    .tp_dealloc = (destructor)engine_dealloc,
    .tp_methods = engine_methods,
};

/* convolve(padded, delays, weights, out): rows of `out` from rows of `padded`, which begin with the past. */
static PyObject *convolve(PyObject *module, PyObject *args) {
    PyObject *padded, *delays, *weights, *out;
    Py_ssize_t rows;
    Py_buffer u, y;
    Stage stage = {{NULL, NULL, 0u}, NULL, NULL, 0};
    (void)module;
    if (!PyArg_ParseTuple(args, "OOOOn", &padded, &delays, &weights, &out, &rows) ||
        (stage_read(&stage, delays, weights) < 0)) {
        return NULL;
    }
    if (buffer_of(padded, &u, 0, 8, "the command") == 0) {
        if (buffer_of(out, &y, 1, 8, "the output") == 0) {
            const size_t longest = longest_of(&stage.shaper);
            const size_t width = (rows > 0) ? (size_t)u.len / 8u / (size_t)rows : 0u;
            const size_t count = (rows > 0) ? (size_t)y.len / 8u / (size_t)rows : 0u;
            if ((rows < 1) || (width != count + longest) || ((size_t)y.len != 8u * count * (size_t)rows)) {
                PyErr_SetString(PyExc_ValueError, "the command must begin with as many samples as the longest delay");
            } else {
                Py_BEGIN_ALLOW_THREADS
                for (size_t row = 0u; row < (size_t)rows; ++row) {
                    preshape_convolve(&stage.shaper, (const double *)u.buf + row * width + longest,
                                      (double *)y.buf + row * count, count);
                }
                Py_END_ALLOW_THREADS
            }
            PyBuffer_Release(&y);
        }
        PyBuffer_Release(&u);
    }
    stage_clear(&stage);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

static PyMethodDef functions[] = {
    {"convolve", convolve, METH_VARARGS, "Shape rows of float64 samples that begin with their past."},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, .m_name = "preshape.kernel._compiled", .m_doc = "The kernel in C.", .m_size = -1,
    .m_methods = functions,
};

PyMODINIT_FUNC PyInit__compiled(void);
PyMODINIT_FUNC PyInit__compiled(void) {
    PyObject *const errors = PyImport_ImportModule("preshape.errors");
    PyObject *self;
    if (errors == NULL) {
        return NULL;
    }
    InputError = PyObject_GetAttrString(errors, "InputError");
    Py_DECREF(errors);
    if ((InputError == NULL) || (PyType_Ready(&EngineType) < 0)) {
        return NULL;
    }
    self = PyModule_Create(&module);
    if ((self == NULL) || (PyModule_AddObjectRef(self, "Engine", (PyObject *)&EngineType) < 0)) {
        Py_XDECREF(self);
        return NULL;
    }
    return self;
}
