mod hidden {
    robstiff::robot!(pub(self) "rv130hsc.yaml");
    robstiff::robot!(pub(in crate::hidden) "staubli-rx160.yaml");
    robstiff::robot!(pub(crate) "fanuc-r2000ic.yaml");
    robstiff::robot!("kuka-kr210-l150.yaml");
}

fn main() {
    let _seen = (hidden::FanucR2000ic, hidden::KukaKr210L150);
    let _private = hidden::Rv130hsc;
    let _private = hidden::StaubliRx160;
}
