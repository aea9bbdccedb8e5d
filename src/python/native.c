/* native.c - the Python extension that holds the library, and what the library calls back. ctypes calls all
   else.

   These functions are C because an interrupt must not arrive in a Python function that the library has
   called: it would be raised where nobody can catch it. Each takes the interpreter, and leaves what it has to
   say in a list. */
#include <Python.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <ffd/points.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Appends the exception that is set to the list, and clears it. */
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

/* Asks the caller's function, if it is not None, whether to go on. Returns 1, 0, or -1 with an exception. */
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

/* The progress of an ffd_run. user: a list of the caller's function or None; what is raised is appended.
   Between the main thread's calls this is where an interrupt is noticed. */
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

/* Appends an object to the list and gives it up; what cannot be is dropped. */
static void append(PyObject *list, PyObject *object)
{
    if (!object || PyList_Append(list, object) != 0)
        PyErr_Clear();
    Py_XDECREF(object);
}

/* A text of the library, in which a file may have other bytes than UTF-8; None for NULL. */
static PyObject *text(const char *bytes)
{
    return bytes ? PyUnicode_DecodeUTF8(bytes, (Py_ssize_t)strlen(bytes), "backslashreplace")
                 : Py_NewRef(Py_None);
}

/* An ffd_log_function. user: a list, which gets (level, line). */
static void take_line(void *user, ffd_log_level level, const char *line)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    append(user, Py_BuildValue("(iN)", (int)level, text(line)));
    PyGILState_Release(state);
}

/* An ffd_parameter_function. user: a list, which gets (name, default, unit, comment, min, max). */
static bool take_parameter(void *user, const ffd_parameter *parameter)
{
    const PyGILState_STATE state = PyGILState_Ensure();
    append(user,
           Py_BuildValue("(NNNNdd)", text(parameter->name), text(parameter->default_value),
                         text(parameter->unit), text(parameter->comment), parameter->min, parameter->max));
    PyGILState_Release(state);
    return true;
}

/* The name of a file, as os.fsdecode has it. */
static PyObject *file_name(const char *name)
{
    return PyUnicode_DecodeFSDefaultAndSize(name, (Py_ssize_t)strlen(name));
}

/* Asks the function for a file: NULL with an exception, None, or bytes, of which the list is the owner. */
static PyObject *find_bytes(PyObject *list, const char *name)
{
    if (PyErr_CheckSignals() != 0)
        return NULL;
    PyObject *const answer = PyObject_CallFunction(PyList_GetItem(list, 0), "N", file_name(name));
    if (!answer || Py_IsNone(answer))
        return answer;
    PyObject *const bytes = PyBytes_FromObject(answer); /* the same, if these are bytes */
    Py_DECREF(answer);
    const int failed = !bytes || PyList_Append(PyList_GetItem(list, 1), bytes) != 0;
    Py_XDECREF(bytes);
    return failed ? NULL : bytes;
}

/* An ffd_resolve_function. user: a list of the caller's function of a name, a list that gets the bytes to
   keep them alive, and what was raised. */
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

/* An ffd_sink_function. user: a list, which gets (name, bytes). */
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

/* An ffd_positions_function. user: a list, which gets the numbers' bytes. */
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

static int add_address(PyObject *module, const char *name, uintptr_t address)
{
    PyObject *const number = PyLong_FromUnsignedLongLong(address);
    const int failed = PyModule_AddObjectRef(module, name, number);
    Py_XDECREF(number);
    return failed;
}

/* The module has the addresses of the functions above. */
PyMODINIT_FUNC PyInit__native(void);
PyMODINIT_FUNC PyInit__native(void)
{
    static PyModuleDef definition = {PyModuleDef_HEAD_INIT, .m_name = "_native", .m_doc = "The library ffd."};
    PyObject *const module = PyModule_Create(&definition);
    if (!module || (add_address(module, "progress", (uintptr_t)progress) == 0 &&
                    add_address(module, "log", (uintptr_t)take_line) == 0 &&
                    add_address(module, "resolve", (uintptr_t)resolve) == 0 &&
                    add_address(module, "sink", (uintptr_t)take_file) == 0 &&
                    add_address(module, "positions", (uintptr_t)take_positions) == 0 &&
                    add_address(module, "parameter", (uintptr_t)take_parameter) == 0))
        return module;
    Py_DECREF(module);
    return NULL;
}
