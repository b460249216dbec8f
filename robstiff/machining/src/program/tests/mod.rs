//! What writers write, readers give back; what people write is kept.

mod hostile;
mod krl;
mod ls;
mod made;
mod rapid;
mod ur;
