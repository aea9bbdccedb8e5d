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
                    add_address(module, "parameter", (uintptr_t)take_parameter) == 0))
        return module;
    Py_DECREF(module);
    return NULL;
}
