/*
 * Makes a library one that Python imports, so that it is found and installed as others are. Its functions
 * are called through their addresses. MODULE is its name.
 */
#include <Python.h>

#define JOINED(name, module) name##module
#define NAME_OF(name, module) JOINED(name, module)
#define QUOTED(name) #name
#define TEXT_OF(name) QUOTED(name)

PyMODINIT_FUNC NAME_OF(PyInit_, MODULE)(void)
{
    static struct PyModuleDef definition = {
        .m_base = PyModuleDef_HEAD_INIT,
        .m_name = TEXT_OF(MODULE),
        .m_doc = "Functions in lanes, which are called through their addresses.",
        .m_size = -1,
    };
    return PyModule_Create(&definition);
}
