/* The kernel as a CPython module: convolve for arrays, Engine for streams. kernel/stream_reference.py is its twin.
 *
 * Engine holds axes x stages rings. It runs without Python's lock while it shapes a block; meanwhile it is marked busy,
 * and any other call on it is refused. Samples are float64 throughout. What it is made of and does is in engine_*.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "engine_state.h"

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
