/* stable_abi.h - what native.c uses of Python's stable ABI, for Windows and macOS (FFD_STABLE_ABI), whose
   headers of Python the system that compiles for them does not have. Elsewhere Python.h comes first, and the
   compiler compares both. The build makes the import library of python3.dll from the lines that begin with
   PYTHON. */
#ifndef FFD_PYTHON_STABLE_ABI_H
#define FFD_PYTHON_STABLE_ABI_H

#include <stddef.h>

#ifdef _WIN32
#define PYTHON __declspec(dllimport)
#define SHOWN __declspec(dllexport)
#else
#define PYTHON extern
#define SHOWN __attribute__((visibility("default")))
#endif

#ifdef FFD_STABLE_ABI
typedef ptrdiff_t Py_ssize_t;
typedef struct stable_object PyObject;
typedef struct stable_method PyMethodDef;
typedef struct stable_module PyModuleDef;
typedef enum { PyGILState_LOCKED, PyGILState_UNLOCKED } PyGILState_STATE;
#define METH_VARARGS 1
#define PY_SSIZE_T_MAX ((Py_ssize_t)(((size_t)-1) >> 1))
#define Py_None (&_Py_NoneStruct)
#define Py_IsNone(object) ((object) == Py_None)
#define Py_DECREF(object) Py_DecRef(object)
#define Py_XDECREF(object) Py_DecRef(object)
/* The sizes in their arguments are Py_ssize_t. */
#define PyArg_ParseTuple _PyArg_ParseTuple_SizeT
#define PyObject_CallFunction _PyObject_CallFunction_SizeT
#define Py_BuildValue _Py_BuildValue_SizeT
#define PyMODINIT_FUNC SHOWN PyObject *
#define PyModuleDef_HEAD_INIT                                                                                \
    {                                                                                                        \
        .ob_base = {.ob_refcnt = 1 }                                                                         \
    }
#define PyModule_Create(definition) PyModule_Create2(definition, PYTHON_ABI_VERSION)
#define PYTHON_ABI_VERSION 3
#endif

struct stable_object {
    Py_ssize_t ob_refcnt;
    void *ob_type;
};

struct stable_method {
    const char *ml_name;
    PyObject *(*ml_meth)(PyObject *, PyObject *);
    int ml_flags;
    const char *ml_doc;
};

struct stable_module {
    struct {
        struct stable_object ob_base;
        PyObject *(*m_init)(void);
        Py_ssize_t m_index;
        PyObject *m_copy;
    } m_base;
    const char *m_name, *m_doc;
    Py_ssize_t m_size;
    PyMethodDef *m_methods;
    void *m_slots, *m_traverse, *m_clear, *m_free;
};

#ifndef FFD_STABLE_ABI
#define HAS_MEMBER(type, other, member)                                                                      \
    _Static_assert(offsetof(struct type, member) == offsetof(other, member), #member)
_Static_assert(sizeof(struct stable_object) == sizeof(PyObject), "PyObject");
_Static_assert(sizeof(struct stable_method) == sizeof(PyMethodDef), "PyMethodDef");
HAS_MEMBER(stable_method, PyMethodDef, ml_meth);
HAS_MEMBER(stable_method, PyMethodDef, ml_flags);
HAS_MEMBER(stable_method, PyMethodDef, ml_doc);
_Static_assert(sizeof(struct stable_module) == sizeof(PyModuleDef), "PyModuleDef");
HAS_MEMBER(stable_module, PyModuleDef, m_name);
HAS_MEMBER(stable_module, PyModuleDef, m_doc);
HAS_MEMBER(stable_module, PyModuleDef, m_size);
HAS_MEMBER(stable_module, PyModuleDef, m_methods);
_Static_assert(METH_VARARGS == 1 && PYTHON_ABI_VERSION == 3 && PyGILState_UNLOCKED == 1, "numbers");
#endif

PYTHON PyObject _Py_NoneStruct;
PYTHON int _PyArg_ParseTuple_SizeT(PyObject *, const char *, ...);
PYTHON PyObject *PyByteArray_FromStringAndSize(const char *, Py_ssize_t);
PYTHON char *PyBytes_AsString(PyObject *);
PYTHON int PyBytes_AsStringAndSize(PyObject *, char **, Py_ssize_t *);
PYTHON PyObject *PyBytes_FromObject(PyObject *);
PYTHON PyObject *PyBytes_FromStringAndSize(const char *, Py_ssize_t);
PYTHON int PyErr_CheckSignals(void);
PYTHON void PyErr_Clear(void);
PYTHON void PyErr_Fetch(PyObject **, PyObject **, PyObject **);
PYTHON void PyErr_NormalizeException(PyObject **, PyObject **, PyObject **);
PYTHON PyObject *PyErr_Occurred(void);
PYTHON int PyException_SetTraceback(PyObject *, PyObject *);
PYTHON PyGILState_STATE PyGILState_Ensure(void);
PYTHON void PyGILState_Release(PyGILState_STATE);
PYTHON int PyList_Append(PyObject *, PyObject *);
PYTHON PyObject *PyList_GetItem(PyObject *, Py_ssize_t);
PYTHON PyObject *PyList_New(Py_ssize_t);
PYTHON int PyList_SetItem(PyObject *, Py_ssize_t, PyObject *);
PYTHON PyObject *PyLong_FromUnsignedLongLong(unsigned long long);
PYTHON int PyModule_AddObjectRef(PyObject *, const char *, PyObject *);
PYTHON PyObject *PyModule_Create2(PyModuleDef *, int);
PYTHON PyObject *_PyObject_CallFunction_SizeT(PyObject *, const char *, ...);
PYTHON int PyObject_IsTrue(PyObject *);
PYTHON PyObject *PyUnicode_DecodeFSDefaultAndSize(const char *, Py_ssize_t);
PYTHON PyObject *PyUnicode_DecodeUTF8(const char *, Py_ssize_t, const char *);
PYTHON PyObject *_Py_BuildValue_SizeT(const char *, ...);
PYTHON void Py_DecRef(PyObject *);
PYTHON PyObject *(Py_NewRef)(PyObject *);

#endif
