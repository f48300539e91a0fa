"""Exported C on a Cortex-M7 with a double-precision unit, emulated by QEMU.

The same program runs on this machine and on the board mps2-an500: every result has the same bits,
and the board counts instructions. `build` compiles it, and `__main__` prints the table.
"""
