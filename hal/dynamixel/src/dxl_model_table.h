/* The servos that the driver knows. Written by tools/interface from tools/brace/data/servos.toml, which has
 * the sources; do not edit. */
/* clang-format off */
#ifndef DXL_MODEL_TABLE_H
#define DXL_MODEL_TABLE_H

/* Rows of dxl_model_t. */
#define DXL_MODEL_TABLE \
    {321, "MX-106", 3.36f, 1615.0f}, \
    {311, "MX-64", 3.36f, 1463.0f}, \
    {1020, "XM430-W350", 2.69f, 1783.0f}, \
    {1030, "XM430-W210", 2.69f, 1304.0f}, \
    {1120, "XM540-W270", 2.69f, 2409.0f}, \
    {1130, "XM540-W150", 2.69f, 1659.0f}, \
    {1100, "XH540-W270", 2.69f, 2020.0f}, \
    {1110, "XH540-W150", 2.69f, 1449.0f}, \
    {1140, "XH540-V270", 2.69f, 3833.0f}, \
    {1150, "XH540-V150", 2.69f, 2667.0f}, \

#endif
