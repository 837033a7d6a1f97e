// Stands in for emitted code: a library of nothing.
