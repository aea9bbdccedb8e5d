/* native.c - the Python extension, which holds the callbacks that the library is given. All calls of the
   library go through ctypes.

   The callbacks are in C because a KeyboardInterrupt inside a Python callback of ctypes could not be caught
   by the caller. Each callback acquires the GIL and stores its results, or an exception, in a list. */
#ifndef FFD_STABLE_ABI
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#endif
#include "python/stable_abi.h"
#include <ffd/batch.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <ffd/points.h>
#include <ffd/program.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Appends the pending exception to the list, and clears it. */
static void keep_exception(PyObject *list)
{
    PyObject *type, *value, *trace;
    PyErr_Fetch(&type, &value, &trace);
    PyErr_NormalizeException(&type, &value, &trace);
    if (value && trace)
        PyException_SetTraceback(value, trace);
    if (!value || PyList_Append(list, value) != 0)
        PyErr_Clear();
    Py_XDECREF(type);
    Py_XDECREF(value);
    Py_XDECREF(trace);
}

/* Calls the caller's progress function, if it is not None. Returns 1 to go on, 0 to stop, -1 with an
   exception. */
static int ask(PyObject *function, double done)
{
    if (Py_IsNone(function))
        return 1;
    PyObject *const answer = PyObject_CallFunction(function, "d", done);
    if (!answer)
        return -1;
    const int goes_on = Py_IsNone(answer) ? 1 : PyObject_IsTrue(answer);
    Py_DECREF(answer);
    return goes_on;
}

/* ffd_run_options.progress. user: a list with the caller's function or None, to which an exception is
   appended. It also checks for an interrupt (Ctrl-C), which Python cannot handle during a call. */
static bool progress(void *user, double done)
{
    PyObject *const list = user;
    const PyGILState_STATE state = PyGILState_Ensure();
    int goes_on = PyErr_CheckSignals() == 0 ? ask(PyList_GetItem(list, 0), done) : -1;
    if (goes_on < 0) {
        keep_exception(list);
        goes_on = 0;
    }
    PyGILState_Release(state);
    return goes_on != 0;
}

/* Appends a new reference to the list and releases it. Drops the object on failure. */
static void append(PyObject *list, PyObject *object)
{
    if (!object || PyList_Append(list, object) != 0)
        PyErr_Clear();
    Py_XDECREF(object);
}

/* Converts a text of the library, which may contain bytes of files that are not UTF-8. NULL becomes None. */
static PyObject *text(const char *bytes)
{
    return bytes ? PyUnicode_DecodeUTF8(bytes, (Py_ssize_t)strlen(bytes), "backslashreplace")
                 : Py_NewRef(Py_None);
}

/* ffd_log_function. user: a list, to which (level, line) is appended. */
static void take_line(void *user, ffd_log_level level, const char *line)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    append(user, Py_BuildValue("(iN)", (int)level, text(line)));
    PyGILState_Release(state);
}

/* ffd_parameter_function. user: a list, to which (name, default, unit, comment, min, max) is appended. */
static bool take_parameter(void *user, const ffd_parameter *parameter)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    append(user,
           Py_BuildValue("(NNNNdd)", text(parameter->name), text(parameter->default_value),
                         text(parameter->unit), text(parameter->comment), parameter->min, parameter->max));
    PyGILState_Release(state);
    return true;
}

/* Converts a file name like os.fsdecode. */
static PyObject *file_name(const char *name)
{
    return PyUnicode_DecodeFSDefaultAndSize(name, (Py_ssize_t)strlen(name));
}

/* Calls the caller's function for a file's bytes. Returns NULL with an exception, None, or bytes that the
   list keeps alive. */
static PyObject *find_bytes(PyObject *list, const char *name)
{
    if (PyErr_CheckSignals() != 0)
        return NULL;
    PyObject *const answer = PyObject_CallFunction(PyList_GetItem(list, 0), "N", file_name(name));
    if (!answer || Py_IsNone(answer))
        return answer;
    PyObject *const bytes = PyBytes_FromObject(answer); /* bytes stay the same object */
    Py_DECREF(answer);
    const int failed = !bytes || PyList_Append(PyList_GetItem(list, 1), bytes) != 0;
    Py_XDECREF(bytes);
    return failed ? NULL : bytes;
}

/* ffd_resolve_function. user: a list with the caller's function, a list that keeps the bytes alive, and then
   an exception, if the function has raised one. */
static ffd_status resolve(void *user, const char *name, ffd_bytes *bytes)
{
    PyObject *const list = user;
    ffd_status status = FFD_OK;
    const PyGILState_STATE state = PyGILState_Ensure();
    PyObject *const found = find_bytes(list, name);
    if (!found) {
        keep_exception(list);
        status = FFD_E_CANCELLED;
    } else if (Py_IsNone(found)) {
        Py_DECREF(found);
    } else {
        char *data = NULL;
        Py_ssize_t size = 0;
        PyBytes_AsStringAndSize(found, &data, &size);
        *bytes = (ffd_bytes){data, (size_t)size};
    }
    PyGILState_Release(state);
    return status;
}

/* ffd_sink_function. user: a list, to which (name, bytes) is appended. */
static ffd_status take_file(void *user, const char *name, const void *bytes, size_t size)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    PyObject *const copy = PyBytes_FromStringAndSize(bytes, (Py_ssize_t)size);
    PyObject *const entry = copy ? Py_BuildValue("(NN)", file_name(name), copy) : NULL;
    const int failed = !entry || PyList_Append(user, entry) != 0;
    if (failed)
        PyErr_Clear();
    Py_XDECREF(entry);
    PyGILState_Release(state);
    return failed ? FFD_E_MEMORY : FFD_OK;
}

/* ffd_positions_function. user: a list, to which the bytes of the numbers are appended. */
static ffd_status take_positions(void *user, const double *positions, size_t count)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    PyObject *const copy = count > (size_t)PY_SSIZE_T_MAX / (3 * sizeof *positions)
                               ? NULL
                               : PyByteArray_FromStringAndSize((const char *)positions,
                                                               (Py_ssize_t)(count * 3 * sizeof *positions));
    const int failed = !copy || PyList_Append(user, copy) != 0;
    PyErr_Clear();
    Py_XDECREF(copy);
    PyGILState_Release(state);
    return failed ? FFD_E_MEMORY : FFD_OK;
}

/* Calls the caller's function for a job, and lets the list keep its line. Returns false with an exception.
 *line: NULL if there are no more jobs. */
static bool find_line(PyObject *list, uint64_t index, const char **line)
{
    if (PyErr_CheckSignals() != 0)
        return false;
    PyObject *const answer = PyObject_CallFunction(PyList_GetItem(list, 0), "K", (unsigned long long)index);
    if (!answer)
        return false;
    *line = Py_IsNone(answer) ? NULL : PyBytes_AsString(answer);
    return PyList_SetItem(list, 1, answer) == 0 && !PyErr_Occurred();
}

/* ffd_batch_next_function. user: a list with a function of the index, which returns bytes or None, the last
   line, and then an exception, if the function has raised one. */
static ffd_status next_job(void *user, uint64_t index, const char **line)
{
    ffd_status status = FFD_OK;
    const PyGILState_STATE state = PyGILState_Ensure();
    if (!find_line(user, index, line)) {
        keep_exception(user);
        status = FFD_E_CANCELLED;
    }
    PyGILState_Release(state);
    return status;
}

/* Functions of the library (connect). */
static size_t (*list_count)(const ffd_output_list *);
static const char *(*list_name)(const ffd_output_list *, size_t);

/* Returns a list of the names of a job's outputs; NULL with an exception. */
static PyObject *names_of(const ffd_output_list *outputs)
{
    PyObject *const names = PyList_New(0);
    for (size_t i = 0; names && i < list_count(outputs); i++) {
        PyObject *const name = file_name(list_name(outputs, i));
        const int failed = !name || PyList_Append(names, name) != 0;
        Py_XDECREF(name);
        if (failed) {
            Py_DECREF(names);
            return NULL;
        }
    }
    return names;
}

/* ffd_batch_ended_function. user: a list, to which (row, line, input, output, skipped, log, outputs, bytes of
   the result) is appended. */
static void job_ended(void *user, const ffd_batch_job *job)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    append(user, Py_BuildValue("(KKNNiNNNy#)", (unsigned long long)job->row, (unsigned long long)job->line,
                               job->input ? file_name(job->input) : text(NULL),
                               job->output ? file_name(job->output) : text(NULL), (int)job->skipped,
                               text(job->log), names_of(job->result->outputs), text(job->result->own_frame),
                               (const char *)job->result, (Py_ssize_t)sizeof *job->result));
    PyGILState_Release(state);
}

static int add_address(PyObject *module, const char *name, uintptr_t address)
{
    PyObject *const number = PyLong_FromUnsignedLongLong(address);
    const int failed = PyModule_AddObjectRef(module, name, number);
    Py_XDECREF(number);
    return failed;
}

/* Arguments of Python that are not called as the members are, or take no keyword; and flags. */
static const char *const others[][2] = {
    {"input.format", "input_format="},
    {"in_place", "output=None"},
    {"lattice", "lattice"},
    {"lattices", "lattices"},
    {"output", "output"},
    {"morphs", "named lattices"},
    {"manifest", "a manifest"},
    {"next", "a list of jobs"},
    {"csv", "a table"},
    {"in", "in_="},
    {"look", "how pictures are drawn"},
    {"blocks", "blocks=True"},
    {"dry_run", "dry_run=True"},
    {"force", "force=True"},
    {"full", "full=True"},
    {"handles", "handles=True"},
    {"pages", "pages=True"},
    {"principal", "principal=True"},
    {"quality", "quality=True"},
    {"resume", "resume=True"},
    {"robust", "robust=True"},
    {"shared_box", "shared_box=True"},
    {"stop", "stop=True"},
};

/* An ffd_spell_function: "falloff=", "outside='extend'". */
static void spell(const char *member, const char *value, char *text, size_t capacity)
{
    const char *const dot = strrchr(member, '.');
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(others[i][0], member) == 0) {
            snprintf(text, capacity, "%s", others[i][1]);
            return;
        }
    snprintf(text, capacity, value ? "%s='%s'" : "%s=", dot ? dot + 1 : member, value);
}

/* connect(ffd_output_list_count, ffd_output_list_name): the addresses of what callbacks call. */
static PyObject *connect(PyObject *module, PyObject *arguments)
{
    unsigned long long count, name;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "KK", &count, &name))
        return NULL;
    list_count = (size_t(*)(const ffd_output_list *))(uintptr_t)count;
    list_name = (const char *(*)(const ffd_output_list *, size_t))(uintptr_t)name;
    return Py_NewRef(Py_None);
}

/* The module's attributes are the addresses of the callbacks above. */
PyMODINIT_FUNC PyInit__native(void);
PyMODINIT_FUNC PyInit__native(void)
{
    static PyMethodDef methods[] = {{.ml_name = "connect", .ml_meth = connect, .ml_flags = METH_VARARGS},
                                    {0}};
    static PyModuleDef definition = {PyModuleDef_HEAD_INIT, .m_methods = methods, .m_name = "_native",
                                     .m_doc = "Callbacks of the library ffd."};
    PyObject *const module = PyModule_Create(&definition);
    if (!module || (add_address(module, "progress", (uintptr_t)progress) == 0 &&
                    add_address(module, "spell", (uintptr_t)spell) == 0 &&
                    add_address(module, "log", (uintptr_t)take_line) == 0 &&
                    add_address(module, "resolve", (uintptr_t)resolve) == 0 &&
                    add_address(module, "sink", (uintptr_t)take_file) == 0 &&
                    add_address(module, "next_job", (uintptr_t)next_job) == 0 &&
                    add_address(module, "job_ended", (uintptr_t)job_ended) == 0 &&
                    add_address(module, "positions", (uintptr_t)take_positions) == 0 &&
                    add_address(module, "parameter", (uintptr_t)take_parameter) == 0))
        return module;
    Py_DECREF(module);
    return NULL;
}
