# SPDX-License-Identifier: BSD-3-Clause
# The longest tests, which ctest starts first, so that none of them is left alone at the end.
