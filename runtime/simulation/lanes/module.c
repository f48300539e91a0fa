/*
 * Makes a library importable by Python, so that it is found and installed like other modules. Its functions are
 * called by their addresses. MODULE is its name.
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
