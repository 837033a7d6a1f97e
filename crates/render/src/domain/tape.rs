//! The recording domain. (Written next.)
